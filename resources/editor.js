// Built by scripts/build-editor.js from scripts/editor and lib. Do not edit.
"use strict";
var nxlineSerialPlc = (() => {
  var __defProp = Object.defineProperty;
  var __getOwnPropNames = Object.getOwnPropertyNames;
  var __typeError = (msg) => {
    throw TypeError(msg);
  };
  var __defNormalProp = (obj, key, value) => key in obj ? __defProp(obj, key, { enumerable: true, configurable: true, writable: true, value }) : obj[key] = value;
  var __commonJS = (cb, mod) => function __require() {
    try {
      return mod || (0, cb[__getOwnPropNames(cb)[0]])((mod = { exports: {} }).exports, mod), mod.exports;
    } catch (e) {
      throw mod = 0, e;
    }
  };
  var __publicField = (obj, key, value) => __defNormalProp(obj, typeof key !== "symbol" ? key + "" : key, value);
  var __accessCheck = (obj, member, msg) => member.has(obj) || __typeError("Cannot " + msg);
  var __privateGet = (obj, member, getter) => (__accessCheck(obj, member, "read from private field"), getter ? getter.call(obj) : member.get(obj));
  var __privateAdd = (obj, member, value) => member.has(obj) ? __typeError("Cannot add the same private member more than once") : member instanceof WeakSet ? member.add(obj) : member.set(obj, value);
  var __privateSet = (obj, member, value, setter) => (__accessCheck(obj, member, "write to private field"), setter ? setter.call(obj, value) : member.set(obj, value), value);
  var __privateMethod = (obj, member, method) => (__accessCheck(obj, member, "access private method"), method);

  // nodes/properties.js
  var require_properties = __commonJS({
    "nodes/properties.js"(exports, module) {
      "use strict";
      var text = (fallback = "", more = {}) => ({ kind: "text", fallback, ...more });
      var number = (fallback, least, most, more = {}) => ({ kind: "number", fallback, least, most, whole: true, ...more });
      var choice = (fallback, ...known) => ({ kind: "choice", fallback, known });
      var flag = (fallback = false) => ({ kind: "flag", fallback });
      var list = () => ({ kind: "list", fallback: [] });
      var bytes = (fallback, most) => ({ kind: "bytes", fallback, most, blank: true, says: `0 to ${most} bytes in hex` });
      var node = () => ({ kind: "node", fallback: "", needed: true });
      var HEALTH = {
        demoteAfter: number(3, 0, 100),
        probeFirst: number(5e3, 100, 36e5),
        probeMost: number(6e4, 100, 36e5)
      };
      var READING = {
        itemsType: choice("list", "list", "msg"),
        items: list(),
        interval: number(1e3, 0, 864e5, { except: [1, 9], says: "0, or 10 to 86400000" }),
        format: choice("object", "object", "message", "envelope", "list"),
        badValues: choice("omit", "omit", "null"),
        ranges: choice("array", "array", "values"),
        booleans: choice("boolean", "boolean", "number"),
        report: choice("all", "all", "changed", "allOnChange"),
        maxSilence: number(0, 0, 864e5)
      };
      var WRITING = {
        target: text(),
        verify: flag(),
        onFailure: choice("error", "error", "output"),
        acceptRetained: flag(),
        coalesce: flag(),
        topic: choice("item", "item", "keep", "fixed"),
        topicText: text()
      };
      var SENDING = {
        access: choice("read", "read", "write"),
        onFailure: choice("error", "error", "output"),
        acceptRetained: flag()
      };
      var PROPERTIES = {
        "plc-line": {
          name: text(),
          transport: choice("serial", "serial", "tcp", "simulated"),
          path: text("", { needed: true }),
          baudRate: number(19200, 50, 4e6),
          dataBits: choice("8", "8", "7"),
          parity: choice("none", "none", "even", "odd"),
          stopBits: choice("1", "1", "2"),
          host: text("", { needed: true }),
          port: number(4001, 1, 65535),
          gap: number(0, 0, 1e4, { whole: false }),
          echo: choice("auto", "auto", "on", "off"),
          flowControl: choice("none", "none", "rtscts", "xonxoff"),
          dtr: choice("unchanged", "unchanged", "on", "off"),
          rts: choice("unchanged", "unchanged", "on", "off"),
          openDelay: number(0, 0, 6e4),
          slack: number(0, 0, 6e4),
          latenessBound: number(0, 0, 36e5),
          queueLimit: number(1e3, 1, 1e5),
          writesBeforePoll: number(4, 1, 1e3)
        },
        "nx-config": {
          name: text(),
          line: node(),
          station: number("", 0, 255, { except: [192, 254], says: "0 to 191, or 255", needed: true, isStation: true }),
          steps: choice("2", "2", "4"),
          timeout: number(3e3, 10, 6e5),
          attempts: number(3, 1, 20),
          ...HEALTH,
          masterIds: text("E2..E9"),
          soleMaster: flag(),
          access: choice("read", "read", "write"),
          writableRanges: text(),
          writeInterval: number(0, 0, 36e5),
          readWords: number(128, 1, 128),
          writeWords: number(64, 1, 127),
          readBits: number(255, 1, 255),
          writeBits: number(254, 1, 254),
          areas: list(),
          tags: list()
        },
        "chino-config": {
          name: text(),
          line: node(),
          station: number("", 0, 247, { needed: true, isStation: true }),
          protocol: choice("rtu", "rtu", "ascii"),
          timeout: number(1e3, 10, 6e5),
          sendWait: number(0, 0, 1e4),
          attempts: number(3, 1, 20),
          ...HEALTH,
          probe08: flag(),
          addressMode: choice("1-base", "1-base", "0-base"),
          coilRead: number(2e3, 1, 2e3),
          coilUnit: number(1, 1, 2e3),
          coilFunction: choice("0F", "0F", "05", "auto"),
          coilWrite: number(1968, 1, 1968),
          discreteRead: number(2e3, 1, 2e3),
          discreteUnit: number(1, 1, 2e3),
          inputRead: number(125, 1, 125),
          holdingRead: number(125, 1, 125),
          holdingFunction: choice("10", "10", "06", "auto"),
          holdingWrite: number(123, 1, 123),
          wordOrder: choice("low", "low", "high"),
          broadcast: flag(),
          turnaround: number(100, 0, 1e4),
          access: choice("read", "read", "write"),
          writableRanges: text(),
          writeInterval: number(0, 0, 36e5),
          tags: list()
        },
        "nx-read": { name: text(), plc: node(), ...READING },
        "nx-write": { name: text(), plc: node(), ...WRITING },
        "chino-regulator": {
          name: text(),
          regulator: node(),
          mode: choice("read", "read", "write", "both"),
          ...READING,
          ...WRITING
        },
        "melsec-c24": {
          name: text(),
          line: node(),
          bidirectional: flag(),
          framing: choice("end", "end", "count", "gap"),
          end: bytes("0D 0A", 2),
          count: number(0, 0, 16384),
          gap: number(0, 0, 6e4),
          format: choice("text", "text", "bytes", "words"),
          encoding: choice("latin1", "latin1", "utf8", "ascii", "euc-kr", "shift_jis"),
          unit: choice("word", "word", "byte"),
          ...SENDING,
          padEven: flag(),
          quiet: number(0, 0, 6e4),
          timer0: number(0, 0, 6e5),
          tornEnd: flag(),
          flow: choice("none", "none", "dc", "driver"),
          transparent: bytes("", 11),
          room: number(64, 1, 4095),
          stallLimit: number(3e4, 100, 36e5),
          asciiBinary: flag(),
          first: bytes("", 80),
          last: bytes("", 80),
          most: number(16384, 1, 65536),
          sumCheck: flag(true),
          ackTimeout: number(1e3, 10, 6e5),
          attempts: number(3, 1, 20),
          repeatUnanswered: flag(),
          priority: choice("both", "both", "c24", "us"),
          repeats: choice("mark", "mark", "drop"),
          repeatAfter: number(0, 0, 36e5),
          repeatWithin: number(1e4, 0, 36e5)
        },
        "incon-link": {
          name: text(),
          line: node(),
          encoding: choice("ascii", "ascii", "latin1", "utf8"),
          checked: flag(),
          acknowledge: flag(),
          ackTimeout: number(1e3, 10, 6e5),
          attempts: number(5, 1, 100),
          most: number(256, 2, 4096),
          silence: number(200, 0, 6e4),
          ...SENDING,
          scan: number(100, 0, 1e4),
          quiet: number(50, 0, 6e4),
          before: number(5, 0, 6e4)
        },
        "plc-monitor": {
          name: text(),
          line: node(),
          events: choice("all", "all", "faults", "audit", "none"),
          interval: number(1e4, 0, 864e5, { except: [1, 99], says: "0, or 100 to 86400000" }),
          trace: flag()
        }
      };
      var VARIABLE = /^\$\{([^}]+)\}$/;
      var readNumber = (row, given) => {
        const value = typeof given === "number" ? given : Number(String(given).trim());
        if (!Number.isFinite(value)) return { problem: "number" };
        if (row.whole && !Number.isInteger(value)) return { problem: "whole" };
        if (value < row.least || value > row.most) return { problem: "range" };
        if (row.except && value >= row.except[0] && value <= row.except[1]) return { problem: "except" };
        return { value };
      };
      var readFlag = (given) => {
        if (given === true || given === "true") return { value: true };
        return given === false || given === "false" ? { value: false } : { problem: "flag" };
      };
      var readChoice = (row, given) => row.known.includes(String(given)) ? { value: String(given) } : { problem: "choice" };
      var HEX = /^(?:[0-9a-f]{2})*$/i;
      var readBytes = (row, given) => {
        const digits = String(given).replace(/\s/g, "");
        const known = HEX.test(digits) && digits.length <= row.most * 2;
        return known ? { value: (digits.match(/../g) ?? []).join(" ").toUpperCase() } : { problem: "bytes" };
      };
      var READERS = {
        bytes: readBytes,
        number: readNumber,
        choice: readChoice,
        flag: (_row, given) => readFlag(given),
        list: (_row, given) => Array.isArray(given) ? { value: given } : { problem: "list" },
        node: (_row, given) => ({ value: String(given) }),
        text: (_row, given) => ({ value: String(given).trim() })
      };
      var readProperty = (row, given) => {
        const empty = typeof given === "string" && given.trim() === "" && !row.blank;
        const missing = given === void 0 || given === null || empty;
        if (missing)
          return row.needed && row.fallback === "" ? { problem: "missing", value: row.fallback } : { value: row.fallback };
        const variable = typeof given === "string" ? VARIABLE.exec(given.trim()) : null;
        if (variable) return { variable: variable[1] };
        return READERS[row.kind](row, given);
      };
      var allowed = (row) => {
        if (row.says) return row.says;
        if (row.kind === "number") return `${row.least} to ${row.most}`;
        return row.known ? row.known.join(", ") : row.kind;
      };
      var TRANSPORTS = { path: "serial", host: "tcp", port: "tcp" };
      var unused = (mode, name) => mode === "read" && name in WRITING || mode === "write" && name in READING;
      var UNIDIRECTIONAL = ["framing", "end", "count", "first", "last", "timer0", "tornEnd"];
      var BIDIRECTIONAL = [
        ...["sumCheck", "ackTimeout", "attempts", "repeatUnanswered", "priority"],
        ...["repeats", "repeatAfter", "repeatWithin"]
      ];
      var FRAMINGS = { end: "end", count: "count" };
      var isOn = (value) => value === true || value === "true";
      var unusedByC24 = (name, { framing = "end", bidirectional = false }) => {
        if (isOn(bidirectional)) return UNIDIRECTIONAL.includes(name);
        return BIDIRECTIONAL.includes(name) || Boolean(FRAMINGS[name]) && FRAMINGS[name] !== framing;
      };
      var ACKNOWLEDGED = ["ackTimeout", "attempts"];
      var applies = (type, name, config) => {
        if (type === "melsec-c24") return !unusedByC24(name, config);
        if (type === "incon-link") return !ACKNOWLEDGED.includes(name) || isOn(config.acknowledge);
        if (type === "plc-line") return !TRANSPORTS[name] || TRANSPORTS[name] === (config.transport || "serial");
        return type !== "chino-regulator" || !unused(config.mode || "read", name);
      };
      module.exports = { PROPERTIES, readProperty, allowed, applies };
    }
  });

  // nodes/listening-rules.js
  var require_listening_rules = __commonJS({
    "nodes/listening-rules.js"(exports, module) {
      "use strict";
      var { PROPERTIES, readProperty } = require_properties();
      var LISTENERS = {
        "melsec-c24": {
          title: "MELSEC C24",
          shared: [
            ...[
              "bidirectional",
              "framing",
              "end",
              "count",
              "gap",
              "most",
              "first",
              "last",
              "asciiBinary",
              "unit",
              "sumCheck"
            ],
            ...["padEven", "flow", "transparent", "room", "stallLimit", "timer0", "tornEnd"],
            ...["priority", "repeatAfter", "repeatWithin"]
          ]
        },
        "incon-link": { title: "INCON", shared: ["most", "silence", "checked", "acknowledge", "encoding"] }
      };
      var shown = (value) => value === "" ? "none" : value;
      var valueOf = ({ type, settings }, name) => readProperty(PROPERTIES[type][name], settings[name]).value;
      var portConflict = (one, other) => {
        if (one.type !== other.type)
          return `the one is ${LISTENERS[one.type].title}, the other ${LISTENERS[other.type].title}`;
        const name = LISTENERS[one.type].shared.find((each) => valueOf(one, each) !== valueOf(other, each));
        return name ? `${name} is ${shown(valueOf(one, name))} and ${shown(valueOf(other, name))}` : "";
      };
      module.exports = { LISTENERS, portConflict };
    }
  });

  // lib/error.js
  var require_error = __commonJS({
    "lib/error.js"(exports, module) {
      "use strict";
      var CODES = Object.freeze({
        // --- what the user typed: found before anything is sent
        BAD_ADDRESS: [
          '"{address}" is not an address: {reason}',
          "Write M0, K127.12, W10:float32 or M0..M127 for an NX PLC; 400108, 401001.05, hr107:float32 or 001001..001016 for MODBUS."
        ],
        UNKNOWN_AREA: [
          '"{address}" names the area {area}, which this station does not have',
          "Known areas: {known}. Add a row to the area table if the CPU has more."
        ],
        OUT_OF_AREA: [
          '"{address}" lies outside its area: {area} has {range}',
          "Use an address inside the area, or correct the area table, or the address mode."
        ],
        BAD_BIT: ['"{address}" asks for bit {bit}', "Bits are numbered in decimal from 0 to 15."],
        BAD_COUNT: ["{count} {unit} cannot be asked for at once: {reason}", "Ask for {least} to {most}."],
        BAD_TYPE: ['"{type}" is not a data type: {reason}', "Known types: {known}."],
        BAD_TAG: ["the tag {name} is not valid: {reason}", "Correct the tag table."],
        BAD_AREA: ["the area row {name} is not valid: {reason}", "Correct the area table."],
        BAD_STATION: ["station {station} is not possible: {reason}", "Use the number that is set on the device."],
        BAD_MASTER_ID: [
          "master ID {id} is not possible: {reason}",
          "Use 192 to 254, or a number of 0 to 191 that no station of the line has."
        ],
        BAD_SETTING: ["{setting} is {value}: {reason}", "Correct the setting."],
        ENV_MISSING: [
          "the environment variable {variable} that {setting} refers to is not set",
          "Set it where Node-RED is started, or type the value."
        ],
        BAD_ITEMS: [
          "the list of items cannot be used: {reason}",
          "Give addresses or tag names: an array of strings, or one string with commas."
        ],
        BAD_VALUE: ["{item} cannot take the value {value}: {reason}", "Send a value that fits the type."],
        VALUE_OUT_OF_RANGE: ["{item} cannot take {value}: allowed is {least} to {most}", "Send a value inside the limits."],
        NOTHING_TO_WRITE: [
          "the message names nothing to write: {reason}",
          "Set a target in the node, an object of name: value as payload, or the item as topic."
        ],
        // --- guards: refused before anything is sent
        READ_ONLY: [
          "{item} was not written: station {station} is read-only here",
          'Set Access to "read and write" in the configuration of the device.'
        ],
        NOT_WRITABLE: [
          "{item} was not written: {reason}",
          "Mark the tag as writable, add its range to the writable ranges, or fix the target in the node."
        ],
        RETAINED_REFUSED: [
          "a retained MQTT message was not written to {item}",
          "Publish set values without retain, or accept retained messages in the node."
        ],
        STEP_TOO_LARGE: [
          "{item} was not written: it is {now} now, and {value} is a step of more than {most}",
          "Go there in smaller steps, or allow a larger step in the tag table."
        ],
        WRITE_TOO_SOON: [
          "{item} was not written: it may be written again in {wait} ms",
          "Write less often, let the node write only the latest value, or shorten the write interval of the device."
        ],
        SENDING_OFF: ["{node} sent nothing: it only receives", 'Set Access to "receive and send" in the node.'],
        FUNCTION_REFUSED: [
          "the function {function} is never sent",
          "Only the functions that read and write bits and words are used."
        ],
        FRAME_TOO_LONG: ["{what} does not fit into one frame: {got} of at most {most} bytes", "Split it."],
        TOO_MANY: ["{count} {unit} at once are too many: at most {most}", "Split the message."],
        END_CODE_INSIDE: [
          "the message was not sent: it contains {code} at byte {at}; {reason}",
          "Change the message, choose another end code, or use ASCII-binary conversion on both sides."
        ],
        FLOW_CODE_INSIDE: [
          "the message was not sent: its byte {at} is {code}, which the flow control takes out",
          "Set a transparent code on both sides, or use ASCII-binary conversion or flow control by wire."
        ],
        ODD_COUNT: [
          "the message was not sent: {count} bytes are an odd count; {reason}",
          'Switch "pad to even" on, send an even count, or use byte units on both sides.'
        ],
        // --- the station's own word
        PLC_WRONG_FUNCTION: [
          "station {station} answers error 1: wrong function code",
          "This CPU does not know the function. Try the other number of steps."
        ],
        PLC_OUT_OF_RANGE: [
          "station {station} answers error 2: {address} is out of range",
          "The CPU does not have this address. Correct it, or the area table."
        ],
        PLC_WRONG_FRAME: [
          "station {station} answers error 3: wrong frame structure",
          "Report it with a trace: this is a fault of the frame."
        ],
        PLC_NOT_PERFORMED: [
          "station {station} answers error 4: the CPU did not perform it",
          "Look at the mode switch and the state of the CPU."
        ],
        PLC_FRAME_TOO_LONG: [
          "station {station} answers error 5: the frame is too long",
          "Lower the limits per frame in the configuration of the PLC."
        ],
        PLC_NO_SERVICE: [
          'station {station} answers "no service"',
          "This CPU does not offer the function. Try the other number of steps."
        ],
        MODBUS_ILLEGAL_FUNCTION: [
          "station {station} answers exception 01: illegal function ({function})",
          "The device does not have this function. Choose the other write function, or another kind of address."
        ],
        MODBUS_ILLEGAL_ADDRESS: [
          "station {station} answers exception 02: it does not have {address}",
          "Correct the address or the address mode (1-base, 0-base); a device may also refuse a range that is too long."
        ],
        MODBUS_ILLEGAL_VALUE: [
          "station {station} answers exception 03: illegal data value",
          "Send a value that the device accepts, or lower the counts per request in the configuration of the regulator."
        ],
        MODBUS_DEVICE_FAILURE: [
          "station {station} answers exception 04: slave device failure",
          "The device failed while it carried out the request. Look at its display."
        ],
        MODBUS_ACKNOWLEDGE: [
          "station {station} answers exception 05: accepted, but it takes a long time",
          "Read the result later."
        ],
        MODBUS_BUSY: ["station {station} answers exception 06: slave device busy", "Ask again later, or poll less often."],
        MODBUS_NEGATIVE_ACKNOWLEDGE: [
          "station {station} answers exception 07: it cannot carry this out",
          "Look at the mode of the device: it may be in local or program operation."
        ],
        MODBUS_MEMORY_PARITY: [
          "station {station} answers exception 08: memory parity error",
          "The device found its memory damaged. Have it serviced."
        ],
        MODBUS_GATEWAY_PATH: [
          "station {station} answers exception 0A: the gateway has no path to it",
          "Correct the configuration of the gateway."
        ],
        MODBUS_GATEWAY_TARGET: [
          "station {station} answers exception 0B: the device behind the gateway does not answer",
          "Check power, cable and station number behind the gateway."
        ],
        MODBUS_EXCEPTION: [
          "station {station} answers exception {exception}, which the protocol does not name",
          "Look it up in the manual of the device."
        ],
        C24_NAK: [
          "{station} did not take the message: NAK {nak}, {reason}",
          "Look the code up in the manual of the module; send it again when the cause is gone."
        ],
        PEER_RESTARTED: [
          "{station} has started anew: whether it had taken the line before is not known",
          "Look at the controller before you send the line again."
        ],
        OWN_ECHO: [
          "{line} hears what it sends, so that nothing it hears can be taken for an acknowledgement",
          'Set Echo of the line to "on": the adapter hears itself.'
        ],
        // --- the conversation
        TIMEOUT: [
          "station {station} did not answer within {timeout} ms",
          "Check power, cable, A and B, station number and speed."
        ],
        STATION_DEMOTED: [
          "station {station} was not asked: it has been silent for {lasting}, and is probed {when}",
          "Check its power, cable and station number. It comes back by itself."
        ],
        INCOMPLETE: [
          "the answer of station {station} stopped after {got} of {expected} bytes",
          "Check cable, earth and terminators; a serial server may cut frames."
        ],
        CRC_ERROR: [
          "the answer of station {station} was damaged: {got}",
          "Check cable, earth, terminators, speed and parity."
        ],
        BAD_ANSWER: [
          "the answer of station {station} makes no sense: {reason}",
          "Check that no other master uses this number."
        ],
        WRITE_UNKNOWN: [
          "it is not known whether station {station} carried out the write of {item}: {reason}",
          "Read it back before you write again."
        ],
        NOT_A_VALUE: ["{item} cannot be read as {type}: {reason}", "Check the data type and the word order of the item."],
        VERIFY_FAILED: [
          "{item} reads {got} after {expected} was written",
          "The program of the PLC, or the device itself, may overwrite it."
        ],
        // --- the line
        QUEUE_FULL: ["the queue of {line} is full ({most} requests)", "Poll less often, or fewer items."],
        DEADLINE: [
          "the request waited longer than {limit} ms on {line} and was not sent",
          "The line is overloaded: poll less often, or fewer items."
        ],
        LINE_CLOSED: [
          "{line} was closed while the request waited",
          "Nothing to do after a deploy; else look at the events of the line."
        ],
        LINE_DOWN: ["{line} is not connected: {reason}", "It reconnects by itself once the cause is gone."],
        LINE_JAMMED: [
          "{line} is never silent: {bytes} bytes without a pause",
          "Something sends without being asked: check the wiring, the speed and other masters."
        ],
        WRITE_STALLED: [
          "{line} does not take the bytes: flow control was not released",
          "Switch flow control off, or check the CTS wire."
        ],
        PORT_NOT_FOUND: [
          "the port {path} does not exist",
          "Plug the adapter in, or choose another port. Names in /dev/serial/by-id stay the same."
        ],
        PORT_BUSY: [
          "the port {path} is in use by another program",
          "Close the other program (a terminal, ModemManager, another Node-RED)."
        ],
        PORT_DENIED: [
          "the port {path} may not be opened by this user",
          "Add the user that runs Node-RED to the group dialout (or uucp), then log in again."
        ],
        PORT_GONE: ["the port {path} has gone", "Plug the adapter in again; it reconnects by itself."],
        PORT_ERROR: ["the port {path} failed: {reason}", "Look at the cause."],
        CONNECT_FAILED: [
          "{path} does not accept the connection: {reason}",
          "Check address, port and the number of connections that the serial server allows."
        ],
        WIRE_IN_USE: [
          "{path} is the same wire as {other}, which {owner} already uses",
          "Use one line configuration for one wire."
        ],
        WIRE_CONFLICT: [
          "{owner} and {other} use {path} with different settings: {reason}",
          "Use one line configuration, or the same settings."
        ],
        LINE_USE: [
          "{owner} and {other} cannot share {line}: {reason}",
          "Give one of them a line of its own: a line asks stations, or listens to messages in one way."
        ],
        SUPERSEDED: [
          "{item} was not written: a newer value came while this one waited",
          'Nothing to do; switch "only the latest" off in the node to write every value.'
        ],
        MIXED_LINE: [
          "{owner} and {other} cannot share {line}: {reason}",
          "Change one of the numbers, or give one of them a line of its own."
        ],
        BROADCAST_REFUSED: [
          "{what} cannot be broadcast: {reason}",
          "Allow broadcasts in the configuration, or address one station."
        ],
        BROADCAST_UNCONFIRMED: [
          "{item} was sent to all stations of {line}; no station acknowledges a broadcast",
          "Read the stations one by one if you must know."
        ],
        DUPLICATE_STATION: [
          "{owner} and {other} are both station {station} of {line}",
          "Use one configuration for one device, or correct the number."
        ],
        // --- the simulator
        SIM_DEADLOCK: ["nothing can happen any more, but this is still open: {open}", "Report it with the seed of the run."],
        NO_PTY: [
          "no virtual serial port can be made: {reason}",
          "Use TCP, or install @lydell/node-pty beside this package (Linux, macOS)."
        ],
        NO_CONFIGURATION: ["{node} has no {what}", "Choose one in the dialog of the node."]
      });
      var MOST_SHOWN = 50;
      var MOST_TEXT = 200;
      var firstPairs = (object) => {
        const pairs = [];
        for (const key in object) if (Object.hasOwn(object, key) && pairs.push([key, object[key]]) >= MOST_SHOWN) break;
        return Object.fromEntries(pairs);
      };
      var shortened = (value) => {
        if (Array.isArray(value) || ArrayBuffer.isView(value)) {
          const isLong = (
            /** @type {any} */
            value.length > MOST_SHOWN
          );
          return isLong ? Array.from({ length: MOST_SHOWN }, (_, n) => value[n]) : value;
        }
        return value !== null && typeof value === "object" ? firstPairs(value) : value;
      };
      var asJson = (value) => {
        let left = MOST_SHOWN;
        return JSON.stringify(value, (_, inner) => left-- > 0 ? shortened(inner) : void 0) ?? String(value);
      };
      var textOf = (value) => {
        if (value === void 0) return "?";
        if (typeof value === "string") return value;
        try {
          return asJson(value);
        } catch {
          return typeof value;
        }
      };
      var UNSEEN = /[\x00-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff]/g;
      var escaped = (character) => `\\u${character.charCodeAt(0).toString(16).padStart(4, "0")}`;
      var shown = (value) => textOf(value).slice(0, MOST_TEXT).replace(UNSEEN, escaped);
      var fill = (text, details) => text.replace(/\{(\w+)\}/g, (_, name) => shown(details[name]));
      var PlcError = class extends Error {
        /**
         * @param {keyof typeof CODES} code
         * @param {Record<string, any> & { cause?: unknown }} [details] values for the text; `cause` becomes `Error.cause`
         */
        constructor(code, details = {}) {
          const row = CODES[code];
          if (!row) throw new TypeError(`unknown error code ${code}`);
          const { cause, ...rest } = details;
          super(`${fill(row[0], rest)}. ${fill(row[1], rest)}`, cause === void 0 ? void 0 : { cause });
          this.name = "PlcError";
          this.code = code;
          this.details = rest;
          this.remedy = fill(row[1], rest);
        }
      };
      var REFUSAL = /^(PLC|MODBUS|C24)_/;
      var isRefusal = (error) => typeof error?.code === "string" && REFUSAL.test(error.code);
      var causeOf = ({ message, remedy }) => message.endsWith(`. ${remedy}`) ? message.slice(0, -remedy.length - 2) : message;
      var isPlcError = (error) => {
        try {
          return error instanceof PlcError;
        } catch {
          return false;
        }
      };
      var reasonOf = (error) => {
        try {
          return String(error?.message ?? error);
        } catch {
          return "it does not say why";
        }
      };
      module.exports = { CODES, PlcError, causeOf, isPlcError, isRefusal, reasonOf };
    }
  });

  // lib/codec/nx/functions.js
  var require_functions = __commonJS({
    "lib/codec/nx/functions.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var FUNCTIONS = table([
        // name            2-step 4-step most unit        repeatable sendable
        ["readBits", 33, 1, 255, "bits", true, true],
        ["writeBits", 34, 2, 254, "bits", false, true],
        ["readWords", 35, 3, 128, "words", true, true],
        ["writeWords", 36, 4, 127, "words", false, true],
        ["readMixed", 37, 5, 128, "addresses", true, true],
        ["writeMixed", 38, 6, 85, "addresses", false, true],
        ["readProgram", 39, 7, 0, "", false, false],
        ["writeProgram", 40, 8, 0, "", false, false],
        ["readInstruction", 41, 9, 0, "", false, false],
        ["changeInstruction", 42, 10, 0, "", false, false],
        ["changeOperand", 43, 11, 0, "", false, false],
        ["insertInstruction", 44, 12, 0, "", false, false],
        ["deleteInstruction", 45, 13, 0, "", false, false],
        ["searchInstruction", 46, 14, 0, "", false, false],
        ["searchOperand", 47, 15, 0, "", false, false],
        ["deleteProgram", 32, 16, 0, "", false, false],
        ["noService", 0, 0, 0, "", false, false]
      ]);
      function table(rows) {
        return Object.freeze(
          rows.map(
            ([name, two, four, most, unit, repeatable, sendable]) => Object.freeze({ name, two, four, most, unit, repeatable, sendable })
          )
        );
      }
      var ANSWER = 128;
      var ACKNOWLEDGE = 128;
      var RESPONSE_REQUEST = 0;
      var NO_SERVICE = 0;
      var ERRORS = Object.freeze({
        1: "PLC_WRONG_FUNCTION",
        2: "PLC_OUT_OF_RANGE",
        3: "PLC_WRONG_FRAME",
        4: "PLC_NOT_PERFORMED",
        5: "PLC_FRAME_TOO_LONG"
      });
      var byName = new Map(FUNCTIONS.map((row) => [row.name, row]));
      var byCode = /* @__PURE__ */ new Map();
      for (const row of FUNCTIONS) {
        if (row.name === "noService") continue;
        byCode.set(row.two, { row, steps: 2 });
        byCode.set(row.four, { row, steps: 4 });
      }
      function functionOf(name) {
        const row = typeof name === "string" ? byName.get(name) : void 0;
        if (!row || !row.sendable) throw new PlcError("FUNCTION_REFUSED", { function: String(name) });
        return row;
      }
      var queryCode = (row, steps) => steps === 4 ? row.four : row.two;
      var answerCode = (row, steps) => queryCode(row, steps) + ANSWER;
      var functionByCode = (code) => byCode.get(code);
      module.exports = {
        FUNCTIONS,
        ERRORS,
        ANSWER,
        ACKNOWLEDGE,
        RESPONSE_REQUEST,
        NO_SERVICE,
        functionOf,
        functionByCode,
        queryCode,
        answerCode
      };
    }
  });

  // lib/codec/modbus/functions.js
  var require_functions2 = __commonJS({
    "lib/codec/modbus/functions.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var FUNCTIONS = table([
        // fn  table  unit    request      most  answer  reads
        [1, "co", "bits", "block", 2e3, "bits", true],
        [2, "di", "bits", "block", 2e3, "bits", true],
        [3, "hr", "words", "block", 125, "words", true],
        [4, "ir", "words", "block", 125, "words", true],
        [5, "co", "bits", "single", 1, "echo", false],
        [6, "hr", "words", "single", 1, "echo", false],
        [15, "co", "bits", "multiple", 1968, "echo", false],
        [16, "hr", "words", "multiple", 123, "echo", false]
      ]);
      function table(rows) {
        return Object.freeze(
          rows.map(
            ([fn, name, unit, request, most, answer, reads]) => Object.freeze({ fn, table: name, unit, request, most, answer, reads })
          )
        );
      }
      var EXCEPTION = 128;
      var LOOPBACK = 8;
      var byNumber = new Map(FUNCTIONS.map((row) => [row.fn, row]));
      var find = (name, request) => (
        /** @type {FunctionRow} */
        FUNCTIONS.find((row) => row.table === name && row.request === request) ?? null
      );
      function functionOf(fn) {
        const row = byNumber.get(
          /** @type {number} */
          fn
        );
        if (!row) throw new PlcError("FUNCTION_REFUSED", { function: String(fn) });
        return row;
      }
      var functionByNumber = (fn) => byNumber.get(fn);
      var readFunction = (name) => find(name, "block").fn;
      var writeFunction = (name, { single }) => find(name, single ? "single" : "multiple")?.fn ?? null;
      module.exports = { EXCEPTION, FUNCTIONS, LOOPBACK, functionByNumber, functionOf, readFunction, writeFunction };
    }
  });

  // lib/codec/modbus/address.js
  var require_address = __commonJS({
    "lib/codec/modbus/address.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { readFunction, writeFunction } = require_functions2();
      var SIZE = 65536;
      var MOST_CHARACTERS = 64;
      var MOST_RANGE = 4096;
      var TABLES = Object.freeze(
        /** @type {[TableName, string, 'bit'|'word', string, number, boolean][]} */
        [
          ["co", "coil", "bit", "0", 2097152, true],
          ["di", "discrete input", "bit", "1", 2162688, false],
          ["ir", "input register", "word", "3", 65536, false],
          ["hr", "holding register", "word", "4", 0, true]
        ].map(
          ([table, name, kind, digit, base, writable]) => Object.freeze({ table, name, kind, digit, base, writable, size: SIZE })
        )
      );
      var byDigit = new Map(TABLES.map((row) => [row.digit, row]));
      var byName = new Map(TABLES.map((row) => [row.table, row]));
      var PANEL = /^(\d+)(?:\.(\d*))?$/;
      var EXPLICIT = /^(co|di|ir|hr)(\d+)(?:\.(\d*))?$/;
      var rowOf = (table) => (
        /** @type {any} */
        byName.get(
          /** @type {TableName} */
          table
        )
      );
      function parseAddress(text, { addressMode = "1-base" } = {}) {
        if (typeof text === "number") throw bad(text, 'a number loses its zeros; write the address in quotes, as in "010197"');
        if (typeof text !== "string") throw bad("", "it is not text");
        const clean = text.trim();
        if (clean === "") throw bad(text, "it is empty", { why: "empty" });
        if (clean.length > MOST_CHARACTERS)
          throw bad(`${clean.slice(0, 20)}…`, `it has more than ${MOST_CHARACTERS} characters`);
        const [first, last, more] = clean.split(/\s*\.\.\s*/);
        if (more !== void 0) throw bad(clean, "a range has two ends");
        const from = parseOne(first, clean, addressMode);
        if (last === void 0) return finish(from, 1, addressMode);
        return range(from, parseOne(last, clean, addressMode), { clean, addressMode });
      }
      function range(from, to, { clean, addressMode }) {
        if (from.row !== to.row) throw bad(clean, `one end is of the ${from.row.name}s, the other of the ${to.row.name}s`);
        if (from.kind !== to.kind) throw bad(clean, "one end is a bit, the other a register");
        if (from.style !== to.style) throw bad(clean, "both ends must be written in the same way");
        const count = to.address - from.address + 1;
        if (count < 1) throw bad(clean, "the range runs backwards", { why: "backwards" });
        if (count > MOST_RANGE) {
          const reason = "the range is too long";
          throw new PlcError("BAD_COUNT", { count, unit: `${from.kind}s`, reason, least: 1, most: MOST_RANGE });
        }
        return finish(from, count, addressMode);
      }
      var FORMS = "like 400108, 40108 or hr107";
      function parseOne(part, whole, addressMode) {
        const clean = part.trim().toLowerCase();
        const explicit = EXPLICIT.exec(clean);
        if (explicit) {
          const [, name, digits2, bit2] = explicit;
          return place(rowOf(name), Number(digits2), { bit: bit2, whole, style: "explicit", first: 0 });
        }
        const found = PANEL.exec(clean);
        if (!found)
          throw part === "" ? bad(whole, "one end of the range is missing") : bad(whole, `it is not ${FORMS}`, { why: "form" });
        const [, digits, bit] = found;
        if (digits.length !== 5 && digits.length !== 6) throw wrongDigits(whole, digits);
        const row = byDigit.get(digits[0]);
        if (!row)
          throw bad(
            whole,
            `the first digit is ${digits[0]}, not 0 (coil), 1 (discrete input), 3 (input register) or 4 (holding register)`,
            { why: "firstDigit", digit: digits[0] }
          );
        return place(row, Number(digits.slice(1)), { bit, whole, style: "panel", first: addressMode === "0-base" ? 0 : 1 });
      }
      var wrongDigits = (whole, digits) => {
        const { length } = digits;
        const reason = `it has ${length === 1 ? "1 digit" : `${length} digits`} instead of 6 or 5`;
        if (length > 5) return bad(whole, reason, { why: "digits", digits: length });
        const padded = digits.padStart(6, "0");
        const hint = `; a zero in front may have been lost, as in ${padded}`;
        return bad(whole, reason + hint, { why: "zeroLost", digits: length, padded });
      };
      function place(row, number, { bit, whole, style, first }) {
        const wire = number - first;
        if (!(wire >= 0 && wire < SIZE)) {
          const numbers = `${first}..${SIZE - 1 + first}`;
          throw new PlcError("OUT_OF_AREA", {
            address: whole,
            area: `the table of ${row.name}s`,
            range: `the numbers ${numbers}`,
            notation: "modbus",
            numbers
          });
        }
        if (bit === void 0) return { kind: row.kind, address: row.base + wire, row, style };
        if (row.kind === "bit") throw bad(whole, `a ${row.name} is a bit: nothing follows its number`, { why: "bitOfBit" });
        return { kind: "bit", address: (row.base + wire) * 16 + bitOf(bit, whole), row, style };
      }
      function bitOf(digits, whole) {
        if (digits.length !== 2) {
          const hint = digits.length === 1 ? `: .${digits} could be .0${digits} or .${digits}0` : "";
          throw bad(whole, `a bit of a register has two digits, .00 to .15${hint}`, { why: "bitDigits" });
        }
        if (Number(digits) > 15) throw new PlcError("BAD_BIT", { address: whole, bit: Number(digits) });
        return Number(digits);
      }
      function finish({ kind, address, row, style }, count, addressMode) {
        const through = kind === "bit" && row.kind === "word";
        const result = {
          kind,
          address,
          count,
          table: row.table,
          wire: placeOf(kind, address).wire,
          text: formatAddress({ kind, address, count, style }, { addressMode }),
          style,
          writable: row.writable,
          certainty: "certain"
        };
        if (through) result.throughWord = { address: address >> 4, bit: address & 15, writable: row.writable };
        return result;
      }
      function placeOf(kind, address) {
        const at = (name, number) => TABLES.find((row) => row.kind === name && number >= row.base && number < row.base + SIZE);
        const own = Number.isInteger(address) ? at(kind, address) : void 0;
        if (own) return { table: own.table, wire: address - own.base };
        const word = kind === "bit" && Number.isInteger(address) && address >= 0 ? at("word", address >> 4) : void 0;
        if (word) return { table: word.table, wire: (address >> 4) - word.base, bit: address & 15 };
        throw bad(String(address), `no ${kind} has this absolute address`);
      }
      function formatAddress({ kind, address, count = 1, style = "panel" }, { addressMode = "1-base" } = {}) {
        const one = (at) => {
          const { table, wire, bit } = placeOf(kind, at);
          const tail = bit === void 0 ? "" : `.${String(bit).padStart(2, "0")}`;
          if (style === "explicit") return `${table}${wire}${tail}`;
          const number = addressMode === "0-base" ? wire : wire + 1;
          return `${rowOf(table).digit}${String(number).padStart(5, "0")}${tail}`;
        };
        return count === 1 ? one(address) : `${one(address)}..${one(address + count - 1)}`;
      }
      function describeAddress({ kind, address, count = 1 }, options = {}) {
        const first = placeOf(kind, address);
        const last = placeOf(kind, address + count - 1);
        const row = rowOf(first.table);
        const span = spanOf(first.wire, last.wire);
        const read = hex(readFunction(first.table), 2);
        if (options.write && !row.writable) return `${row.name}s cannot be written`;
        const code = options.write ? writeCode(first.table, last.wire - first.wire + 1, options) : read;
        if (first.bit === void 0) return `function ${code}, ${span}`;
        if (options.write) return `functions ${read} and ${code}, read-modify-write of ${span}`;
        return `function ${code}, ${span}, ${count === 1 ? `bit ${first.bit}` : `${count} bits`}`;
      }
      function writeCode(table, count, { coilFunction = "0F", holdingFunction = "10" }) {
        const chosen = table === "co" ? coilFunction : holdingFunction;
        const single = chosen === "05" || chosen === "06" || chosen === "auto" && count === 1;
        return hex(
          /** @type {number} */
          writeFunction(table, { single }),
          2
        );
      }
      var spanOf = (first, last) => first === last ? `wire address ${first} (${hex(first)}h)` : `wire addresses ${first}–${last} (${hex(first)}h–${hex(last)}h)`;
      var hex = (value, digits = 4) => value.toString(16).toUpperCase().padStart(digits, "0");
      var bad = (address, reason, more = {}) => new PlcError("BAD_ADDRESS", { address: String(address), reason, notation: "modbus", ...more });
      module.exports = { TABLES, describeAddress, formatAddress, parseAddress, placeOf, spanOf };
    }
  });

  // lib/tag/convert.js
  var require_convert = __commonJS({
    "lib/tag/convert.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var NUMBER = /^[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:e[+-]?\d+)?$/i;
      var HEX = /^0x[0-9a-f]+$/i;
      var BOOLEANS = /* @__PURE__ */ new Map([
        ["true", true],
        ["on", true],
        ["1", true],
        ["false", false],
        ["off", false],
        ["0", false]
      ]);
      var elementsOf = (list) => Array.from({ length: list.length }, (_, n) => list[n]);
      var absurdity = (value) => {
        if (value === null || value === void 0) return "it is empty";
        if (typeof value === "string" && value.trim() === "") return "it is empty";
        if (typeof value === "number" && !Number.isFinite(value)) return "it is not a finite number";
        return null;
      };
      var refuse = (item, value, reason) => new PlcError("BAD_VALUE", { item, value, reason });
      var toNumber = (value, item) => {
        const absurd = absurdity(value);
        if (absurd) throw refuse(item, value, absurd);
        if (typeof value === "number") return value;
        if (typeof value !== "string") throw refuse(item, value, "a number is needed");
        const text = value.trim();
        if (!NUMBER.test(text) && !HEX.test(text)) throw refuse(item, value, "it is not a number");
        const number = Number(text);
        if (!Number.isFinite(number)) throw refuse(item, value, "it is not a finite number");
        return number;
      };
      var toBoolean = (value, item) => {
        if (typeof value === "boolean") return value;
        const absurd = absurdity(value);
        if (absurd) throw refuse(item, value, absurd);
        const known = typeof value === "number" || typeof value === "string" ? BOOLEANS.get(String(value).trim().toLowerCase()) : void 0;
        if (known === void 0) throw refuse(item, value, "a bit takes true, false, on, off, 1 or 0");
        return known;
      };
      var toText = (value, item, most) => {
        const absurd = absurdity(value);
        if (absurd && value !== "") throw refuse(item, value, absurd);
        if (typeof value !== "string" && typeof value !== "number") throw refuse(item, value, "a text is needed");
        const text = String(value);
        if (text.length > most) throw refuse(item, value, `it has ${text.length} characters, ${most} fit`);
        for (const character of text) {
          if (
            /** @type {number} */
            character.codePointAt(0) > 255
          ) {
            throw refuse(item, value, `the character ${character} does not fit into one byte`);
          }
        }
        return text;
      };
      module.exports = { absurdity, elementsOf, toBoolean, toNumber, toText };
    }
  });

  // lib/tag/types.js
  var require_types = __commonJS({
    "lib/tag/types.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { toBoolean, toNumber, toText } = require_convert();
      var MOST_STRING = 256;
      var WORD_BYTES = 2;
      var LONGEST_NUMBER = 2;
      var VIEWS = Array.from(
        { length: LONGEST_NUMBER + 1 },
        (_, words) => new DataView(new ArrayBuffer(words * WORD_BYTES))
      );
      var viewOf = (words, order) => {
        const { length } = words;
        const view = VIEWS[length];
        for (let index = 0; index < length; index++) {
          view.setUint16(index * WORD_BYTES, words[order === "high" ? length - 1 - index : index], true);
        }
        return view;
      };
      var wordsOf = (view, order) => {
        const words = [];
        for (let at = 0; at < view.byteLength; at += 2) words.push(view.getUint16(at, true));
        return order === "high" ? words.reverse() : words;
      };
      var bcdValue = (raw, digits) => {
        let value = 0;
        for (let place = digits - 1; place >= 0; place--) {
          const digit = Math.floor(raw / 16 ** place) % 16;
          if (digit > 9) return { bad: `${raw.toString(16).toUpperCase().padStart(digits, "0")}h is not BCD` };
          value = value * 10 + digit;
        }
        return { value };
      };
      var bcdRaw = (value) => parseInt(String(value), 16);
      var float = (number) => {
        if (Number.isFinite(number)) return { value: number };
        return { bad: Number.isNaN(number) ? "the bits are not a number (NaN)" : "the bits mean infinity" };
      };
      var MOST_FLOAT = 34028234663852886e22;
      var NUMBERS = [
        // name, words, least, most, whole, read, write
        ["int16", 1, -32768, 32767, true, (v) => ({ value: v.getInt16(0, true) }), (v, x) => v.setInt16(0, x, true)],
        ["uint16", 1, 0, 65535, true, (v) => ({ value: v.getUint16(0, true) }), (v, x) => v.setUint16(0, x, true)],
        ["int32", 2, -2147483648, 2147483647, true, (v) => ({ value: v.getInt32(0, true) }), (v, x) => v.setInt32(0, x, true)],
        ["uint32", 2, 0, 4294967295, true, (v) => ({ value: v.getUint32(0, true) }), (v, x) => v.setUint32(0, x, true)],
        ["float32", 2, -MOST_FLOAT, MOST_FLOAT, false, (v) => float(v.getFloat32(0, true)), (v, x) => v.setFloat32(0, x, true)],
        ["bcd16", 1, 0, 9999, true, (v) => bcdValue(v.getUint16(0, true), 4), (v, x) => v.setUint16(0, bcdRaw(x), true)],
        ["bcd32", 2, 0, 99999999, true, (v) => bcdValue(v.getUint32(0, true), 8), (v, x) => v.setUint32(0, bcdRaw(x), true)]
      ];
      var round = (number) => number < 0 ? -Math.round(-number) || 0 : Math.round(number);
      var numberType = ([name, words, least, most, integer, read, write]) => {
        const encode = (value, { item = name, wordOrder, rounds = false } = {}) => {
          const given = toNumber(value, item);
          const number = integer && rounds ? round(given) : given;
          if (integer && !Number.isInteger(number)) {
            throw new PlcError("BAD_VALUE", { item, value, reason: `${name} takes whole numbers` });
          }
          if (number < least || number > most) throw new PlcError("VALUE_OUT_OF_RANGE", { item, value, least, most });
          const view = new DataView(new ArrayBuffer(words * 2));
          write(view, number);
          return wordsOf(view, wordOrder);
        };
        const decode = (raw, order = {}) => read(viewOf(raw, order.wordOrder));
        return Object.freeze({ name, kind: "word", words, least, most, numeric: true, integer, decode, encode });
      };
      var BOOL = Object.freeze({
        name: "bool",
        kind: "bit",
        words: 1,
        numeric: false,
        integer: false,
        decode: (raw) => ({ value: raw[0] }),
        encode: (value, { item = "bool" } = {}) => [toBoolean(value, item)]
      });
      var stringType = (length) => {
        const words = Math.ceil(length / 2);
        const decode = (raw, { byteOrder } = {}) => {
          let text = "";
          for (let at = 0; at < length; at++) {
            const high = at % 2 === (byteOrder === "high" ? 0 : 1);
            const byte = high ? raw[at >> 1] >> 8 : raw[at >> 1] & 255;
            if (byte === 0) break;
            text += String.fromCharCode(byte);
          }
          return { value: text };
        };
        const encode = (value, { item = "string", byteOrder } = {}) => {
          const text = toText(value, item, length);
          const raw = new Array(words).fill(0);
          for (let at = 0; at < text.length; at++) {
            const high = at % 2 === (byteOrder === "high" ? 0 : 1);
            raw[at >> 1] |= text.charCodeAt(at) << (high ? 8 : 0);
          }
          return raw;
        };
        return Object.freeze({
          name: `string[${length}]`,
          kind: "word",
          words,
          numeric: false,
          integer: false,
          decode,
          encode
        });
      };
      var TYPES = /* @__PURE__ */ new Map();
      TYPES.set("bool", BOOL);
      for (const row of NUMBERS) TYPES.set(row[0], numberType(row));
      var TYPE_NAMES = Object.freeze([...TYPES.keys(), "string[n]"]);
      var parseType = (text) => {
        const name = typeof text === "string" ? text.trim().toLowerCase() : "";
        const known = TYPES.get(name);
        if (known) return known;
        const string = /^string\s*\[\s*(\d+)\s*\]$/.exec(name);
        const length = string ? Number(string[1]) : 0;
        if (length >= 1 && length <= MOST_STRING) return stringType(length);
        const reason = name.startsWith("string") ? `write string[n] with n = 1 to ${MOST_STRING} bytes` : "there is no such type";
        throw new PlcError("BAD_TYPE", { type: text, reason, known: TYPE_NAMES.join(", ") });
      };
      module.exports = { parseType, round };
    }
  });

  // lib/tag/item.js
  var require_item = __commonJS({
    "lib/tag/item.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { parseType } = require_types();
      var TYPED = /^(.*?):\s*([a-z]\w*\s*(?:\[[^\]]*\])?)$/i;
      var LONGEST = 200;
      var splitType = (text) => {
        const typed = TYPED.exec(text);
        return typed ? [typed[1].trimEnd(), typed[2]] : [text, ""];
      };
      var keyOf = (text) => {
        const key = text.replace(/\.\./g, "_").replace(/\W+/g, "_");
        return /^[A-Za-z_]/.test(key) ? key : `_${key}`;
      };
      var plainType = (kind) => kind === "bit" ? "bool" : "uint16";
      var typeFor = (text, { address, typeText, notation }) => {
        const type = parseType(typeText || plainType(address.kind));
        if (type.kind === address.kind) return type;
        const packs = address.kind === "bit" && Boolean(notation.packs?.(address));
        if (packs && type.numeric) return type;
        const known = packs ? "bool and all numbers" : address.kind === "bit" ? "bool" : "all but bool";
        const reason = address.kind === "bit" ? `${text} is a bit, which is bool` : `${text} is a word, bool needs a bit`;
        throw new PlcError("BAD_TYPE", { type: type.name, reason: packs ? `${text} is a bit` : reason, known });
      };
      var isPacked = ({ kind }, type) => kind === "bit" && type.kind === "word";
      var widthOf = (address, type) => isPacked(address, type) ? 16 * type.words : type.words;
      var countOf = (text, { address, type, notation }) => {
        const range = address.count > 1;
        const width = widthOf(address, type);
        const unit = address.kind === "bit" ? "bits" : "words";
        if (range && address.count % width !== 0) {
          throw new PlcError("BAD_TYPE", {
            type: type.name,
            reason: `${text} has ${address.count} ${unit}, which is no multiple of ${width}`,
            known: `ranges of a multiple of ${width} ${unit}`
          });
        }
        const end = address.address + (range ? address.count : width) - 1;
        if (end > notation.last(address)) {
          throw new PlcError("OUT_OF_AREA", {
            address: text,
            area: address.text,
            range: `${notation.last(address) - address.address + 1} ${unit} from there, ${type.name} takes ${width}`
          });
        }
        return { range, count: range ? address.count / width : 1 };
      };
      var elementsOf = (item, notation) => {
        if (!item.range) return [{ name: item.name, text: item.tag ? item.name : item.addressText }];
        return Array.from({ length: item.count }, (_, index) => {
          const { kind, style } = item;
          const text = notation.format({ kind, style, address: item.address + index * widthOf(item, item.type) });
          return { name: item.tag ? `${item.name}_${index}` : keyOf(text), text };
        });
      };
      var tagged = (tag, notation) => ({
        wordOrder: tag?.wordOrder || notation.wordOrder || "low",
        byteOrder: tag?.byteOrder || notation.byteOrder || "low",
        tag: tag ?? null,
        label: tag ? tag.label : "",
        unit: tag ? tag.unit : ""
      });
      var parseExpression = (expression, notation, { tag, text = expression } = {}) => {
        const [addressText, written] = splitType(expression.trim());
        const address = notation.parse(addressText.trim());
        const type = typeFor(expression, { address, typeText: written || tag?.type, notation });
        const item = {
          text,
          name: tag ? tag.name : keyOf(address.text),
          kind: address.kind,
          address: address.address,
          addressText: address.text,
          ...countOf(expression, { address, type, notation }),
          type,
          throughWord: Boolean(address.throughWord),
          packed: isPacked(address, type),
          ...address.style && { style: address.style },
          areaWritable: address.writable,
          ...tagged(tag, notation)
        };
        return withElements(item, notation);
      };
      var withElements = (item, notation) => {
        let elements;
        const get = () => elements ?? (elements = elementsOf(item, notation));
        return Object.defineProperty(item, "elements", { get, enumerable: true });
      };
      var parseItem = (text, notation) => {
        if (typeof text !== "string" || text.trim() === "") {
          const hint = typeof text === "number" ? `, not the number ${text}: write the address in quotes` : "";
          throw new PlcError("BAD_ITEMS", {
            reason: `an item is a text such as ${notation.example ?? "M0"} or a tag name${hint}`
          });
        }
        if (text.length > LONGEST) {
          throw new PlcError("BAD_ADDRESS", {
            address: `${text.slice(0, 20)}…`,
            reason: `it has more than ${LONGEST} characters`
          });
        }
        const name = text.trim();
        const tag = notation.tags?.get(name);
        return tag ? parseExpression(tag.address, notation, { tag, text: name }) : parseExpression(name, notation);
      };
      var meaning = (item) => `${item.tag ? "tag " : ""}${item.kind} ${item.address} ${item.count} ${item.type.name}`;
      var clashes = (items) => {
        const meanings = /* @__PURE__ */ new Map();
        for (const item of items) {
          const known = meanings.get(item.name) ?? /* @__PURE__ */ new Set();
          meanings.set(item.name, known.add(meaning(item)));
        }
        return new Set([...meanings].filter(([, known]) => known.size > 1).map(([name]) => name));
      };
      var distinctNames = (items) => {
        const shared = clashes(items);
        if (shared.size === 0) return items;
        const plain = (item) => item.tag || item.type.name === plainType(item.kind) || !shared.has(item.name);
        const suffix = (item) => `_${keyOf(item.type.name).replace(/_$/, "")}`;
        const renamed = items.map(
          (item) => plain(item) ? item : {
            ...item,
            name: item.name + suffix(item),
            elements: item.elements.map((element) => ({ ...element, name: element.name + suffix(item) }))
          }
        );
        const [still] = clashes(renamed);
        if (still === void 0) return renamed;
        const both = renamed.filter((item) => item.name === still).map((item) => item.text);
        throw new PlcError("BAD_ITEMS", { reason: `${both.join(" and ")} would both be called ${still}` });
      };
      module.exports = { distinctNames, keyOf, parseExpression, parseItem, splitType };
    }
  });

  // lib/tag/tags.js
  var require_tags = __commonJS({
    "lib/tag/tags.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { parseExpression, splitType } = require_item();
      var { parseType } = require_types();
      var FIELDS = Object.freeze([
        ...["name", "label", "address", "type", "wordOrder", "byteOrder", "scale", "offset", "unit", "deadband"],
        ...["writable", "min", "max", "maxStep"]
      ]);
      var NAME = /^[A-Za-z_]\w*$/;
      var RESERVED = new Set(Object.getOwnPropertyNames(Object.prototype).concat("prototype"));
      var MOST_TAGS = 1e4;
      var bad = (name, reason) => new PlcError("BAD_TAG", { name, reason });
      var isPlain = (value) => value === null || !["object", "function", "symbol"].includes(typeof value);
      var textOf = (row, field) => {
        const value = Object.hasOwn(row, field) ? row[field] : void 0;
        return value === void 0 || value === null ? "" : String(value).trim();
      };
      var numberOf = (row, field, { name, fallback }) => {
        const text = textOf(row, field);
        if (text === "") return fallback;
        const number = Number(text);
        if (!Number.isFinite(number)) throw bad(name, `${field} is "${text}", not a number`);
        return number;
      };
      var PERCENT = /^(\d+(?:\.\d+)?)\s*%$/;
      var deadbandOf = (row, name) => {
        const [, percent] = PERCENT.exec(textOf(row, "deadband")) ?? [];
        if (percent === void 0) return numberOf(row, "deadband", { name, fallback: 0 });
        if (Number(percent) > 100) throw bad(name, `deadband is ${percent} %, 100 % at most`);
        return Number(percent) === 0 ? 0 : `${Number(percent)}%`;
      };
      var YES = /* @__PURE__ */ new Set(["true", "1", "yes", "x", "on"]);
      var NO = /* @__PURE__ */ new Set(["", "false", "0", "no", "off"]);
      var booleanOf = (row, field, name) => {
        const text = textOf(row, field).toLowerCase();
        if (YES.has(text)) return true;
        if (NO.has(text)) return false;
        throw bad(name, `${field} is "${text}", write true or false`);
      };
      var orderOf = (row, field, name) => {
        const text = textOf(row, field).toLowerCase();
        if (text === "" || text === "low" || text === "high") return (
          /** @type {''|'low'|'high'} */
          text
        );
        throw bad(name, `${field} is "${text}", write low or high`);
      };
      var readRow = (row, place) => {
        if (!row || typeof row !== "object" || Array.isArray(row)) throw bad(place, "it is not a row of fields");
        const strange = FIELDS.find((field) => Object.hasOwn(row, field) && !isPlain(row[field]));
        if (strange) throw bad(place, `${strange} is neither text nor a number`);
        const name = textOf(row, "name");
        if (!NAME.test(name)) throw bad(name || place, "a name is made of letters, digits and _, and starts with no digit");
        if (RESERVED.has(name)) throw bad(name, "this name is reserved");
        return {
          name,
          label: textOf(row, "label"),
          address: textOf(row, "address"),
          type: textOf(row, "type").toLowerCase(),
          wordOrder: orderOf(row, "wordOrder", name),
          byteOrder: orderOf(row, "byteOrder", name),
          scale: numberOf(row, "scale", { name, fallback: 1 }),
          offset: numberOf(row, "offset", { name, fallback: 0 }),
          unit: textOf(row, "unit"),
          deadband: deadbandOf(row, name),
          writable: booleanOf(row, "writable", name),
          min: numberOf(row, "min", { name, fallback: null }),
          max: numberOf(row, "max", { name, fallback: null }),
          maxStep: numberOf(row, "maxStep", { name, fallback: null })
        };
      };
      var checkNumbers = (tag, type) => {
        const { name, scale, offset, deadband, min, max, maxStep } = tag;
        if (scale === 0) throw bad(name, "scale is 0");
        if (deadband < 0) throw bad(name, "deadband is negative");
        if (min !== null && max !== null && min > max) throw bad(name, `min ${min} is larger than max ${max}`);
        if (maxStep !== null && maxStep <= 0) throw bad(name, `maxStep is ${maxStep}; leave it empty to allow any step`);
        if (type.numeric) return;
        if (scale !== 1 || offset !== 0) throw bad(name, `${type.name} cannot be scaled`);
        if (min !== null || max !== null) throw bad(name, `${type.name} has no min and max`);
        if (maxStep !== null) throw bad(name, `${type.name} has no maxStep`);
      };
      var checkName = (tag, item, notation) => {
        const other = attempt(() => notation.parse(tag.name));
        if (other && (other.kind !== item.kind || other.address !== item.address)) {
          throw bad(tag.name, `its name is the address ${other.text}, but it stands for ${tag.address}`);
        }
      };
      var attempt = (make) => {
        try {
          return make();
        } catch {
          return null;
        }
      };
      var checkTag = (tag, notation) => {
        const [, written] = splitType(tag.address);
        try {
          if (written && tag.type && parseType(written).name !== parseType(tag.type).name) {
            throw bad(tag.name, `its address says ${written}, its type ${tag.type}`);
          }
          const item = parseExpression(tag.address, notation, { tag });
          checkNumbers(tag, item.type);
          checkName(tag, item, notation);
        } catch (caught) {
          const error = (
            /** @type {PlcError} */
            caught
          );
          throw error.code === "BAD_TAG" ? error : new PlcError("BAD_TAG", { name: tag.name, reason: error.message, cause: error });
        }
      };
      var readTags = (rows, notation) => {
        const tags = /* @__PURE__ */ new Map();
        if (rows === void 0 || rows === null || rows === "") return tags;
        if (!Array.isArray(rows)) throw bad("table", "it is not an array of tags");
        if (rows.length > MOST_TAGS) throw new PlcError("TOO_MANY", { count: rows.length, unit: "tags", most: MOST_TAGS });
        rows.forEach((row, index) => {
          const tag = readRow(row, `in row ${index + 1}`);
          if (tags.has(tag.name)) throw bad(tag.name, `row ${index + 1} has the same name again`);
          checkTag(tag, notation);
          tags.set(tag.name, Object.freeze(tag));
        });
        return tags;
      };
      module.exports = { FIELDS, readTags };
    }
  });

  // lib/tag/modbus-notation.js
  var require_modbus_notation = __commonJS({
    "lib/tag/modbus-notation.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { formatAddress, parseAddress, placeOf, TABLES } = require_address();
      var { readTags } = require_tags();
      var MODES = ["1-base", "0-base"];
      var lastOf = ({ kind, address }) => {
        const { table, bit } = placeOf(kind, address);
        const row = (
          /** @type {any} */
          TABLES.find((each) => each.table === table)
        );
        const last = row.base + row.size - 1;
        return bit === void 0 ? last : last * 16 + 15;
      };
      var DIGITS = /^\d+$/;
      var BIT_OF_REGISTER = /^\d{5,6}\.\d$/;
      var LAST_NUMBER = 65536;
      var doubtOf = (text, isBit) => {
        if (BIT_OF_REGISTER.test(text)) return `${text} may have been ${text}0: a bit has two digits`;
        if (!DIGITS.test(text)) return "";
        if (isBit && /^(3|4)(\d{4}|\d{5})$/.test(text)) return `${text} is a register; it may have been the bit ${text}.00`;
        if (text.length < 5) return `${text} may have been ${text.padStart(6, "0")}: it has too few digits`;
        const eaten = text.length === 5 && text[0] !== "0" && Number(text) <= LAST_NUMBER;
        return eaten ? `${text} may have been 0${text}, a coil: write six digits to be sure` : "";
      };
      var doubtsOf = (row) => {
        const [address, type = ""] = String(row.address ?? "").split(":");
        const isBit = [type, row.type].some((each) => /^\s*bool\s*$/i.test(String(each ?? "")));
        const doubts = address.split("..").map((end) => doubtOf(end.trim(), isBit));
        return [...new Set(doubts.filter(Boolean))];
      };
      var modbusNotation = ({ addressMode = "1-base", tags, wordOrder = "low", byteOrder = "high" } = {}) => {
        if (!MODES.includes(addressMode)) {
          const reason = `it must be ${MODES.join(" or ")}`;
          throw new PlcError("BAD_SETTING", { setting: "addressMode", value: addressMode, reason });
        }
        const notation = {
          addressMode,
          example: "400108",
          parse: (text) => parseAddress(text, { addressMode }),
          format: (at) => formatAddress(at, { addressMode }),
          last: lastOf,
          packs: (address) => address.kind === "bit" && !address.throughWord,
          doubts: doubtsOf,
          wordOrder,
          byteOrder
        };
        return { ...notation, tags: readTags(tags, notation) };
      };
      module.exports = { modbusNotation };
    }
  });

  // lib/codec/nx/areas.js
  var require_areas = __commonJS({
    "lib/codec/nx/areas.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var LAST_WORD = 65535;
      var LAST_BIT = 65535;
      var MOST_ROWS = 64;
      var AREAS = table([
        // area  base   words as       certainty      writable note
        ["R", 0, 128, "both", "likely", true, "external I/O"],
        ["L", 128, 64, "both", "likely", true, "link"],
        ["M", 192, 128, "both", "certain", true, "internal relay"],
        ["K", 320, 128, "both", "certain", true, "keep (retentive)"],
        ["F", 448, 16, "both", "unconfirmed", false, "special flags"],
        ["TC", 464, 16, "bits", "unconfirmed", false, "timer and counter contacts"],
        ["W", 512, 2048, "words", "unconfirmed", false, "data"],
        ["SV", 2560, 256, "words", "unconfirmed", false, "set values"],
        ["PV", 2816, 256, "words", "unconfirmed", false, "present values"],
        ["SR", 3072, 512, "words", "unconfirmed", false, "special registers"]
      ]);
      function table(rows) {
        return Object.freeze(
          rows.map(
            ([area, base, words, as, certainty, writable, note]) => Object.freeze({ area, base, words, as, certainty, writable, note })
          )
        );
      }
      var ACCESS = ["both", "bits", "words"];
      var PROPERTIES = ["area", "base", "words", "as", "confirmed", "writable", "remove", "note"];
      var hex = (value) => `$${value.toString(16).toUpperCase().padStart(4, "0")}`;
      var span = (row) => `${row.area} (${hex(row.base)}..${hex(row.base + row.words - 1)})`;
      function areaMap(rows = []) {
        if (!Array.isArray(rows)) throw bad("table", "it is not a list of rows");
        if (rows.length > MOST_ROWS) throw bad("table", `${rows.length} rows, at most ${MOST_ROWS}`);
        const byName = new Map(AREAS.map((row) => [row.area, row]));
        const seen = /* @__PURE__ */ new Set();
        for (const given of rows) {
          const name = nameOf(given);
          if (seen.has(name)) throw bad(name, "two rows have this name");
          seen.add(name);
          const row = merge(name, given, byName.get(name));
          if (row) byName.set(name, row);
          else byName.delete(name);
        }
        const list = Object.freeze([...byName.values()].sort((a, b) => a.base - b.base));
        for (let i = 1; i < list.length; i++) {
          if (list[i - 1].base + list[i - 1].words > list[i].base) {
            throw bad(list[i].area, `${span(list[i])} overlaps ${span(list[i - 1])}`);
          }
        }
        return Object.freeze({
          list,
          get: (name) => byName.get(name),
          at: (word) => list.find((row) => word >= row.base && word < row.base + row.words)
        });
      }
      function nameOf(given) {
        if (given === null || typeof given !== "object" || Array.isArray(given)) throw bad("?", "a row must be an object");
        const name = own(given, "area");
        if (typeof name !== "string" || !/^[A-Za-z]{1,4}$/.test(name))
          throw bad(name, "the name must be 1 to 4 letters A to Z");
        const unknown = Object.keys(given).find((key) => !PROPERTIES.includes(key));
        if (unknown !== void 0) throw bad(name, `it has the unknown property ${unknown}`);
        return name.toUpperCase();
      }
      function merge(name, given, old) {
        if (flag(name, given, "remove")) {
          if (!old) throw bad(name, "there is no such area to remove");
          return null;
        }
        const base = number(name, given, "base", old);
        const words = number(name, given, "words", old);
        const as = own(given, "as") ?? old?.as ?? "both";
        if (!ACCESS.includes(as)) throw bad(name, '"as" must be both, bits or words');
        if (words < 1) throw bad(name, "it must have at least one word");
        const last = base + words - 1;
        if (last > LAST_WORD) throw bad(name, `it ends at ${hex(last)}, after the last word ${hex(LAST_WORD)}`);
        if (as === "bits" && last * 16 + 15 > LAST_BIT)
          throw bad(name, `its bits end after ${hex(LAST_BIT)}: use "as": "words"`);
        return Object.freeze({ area: name, base, words, as, ...trust(name, given, { base, words, as, old }) });
      }
      function trust(name, given, { base, words, as, old }) {
        const confirmed = flag(name, given, "confirmed");
        const writable = flag(name, given, "writable");
        const note = own(given, "note") ?? old?.note ?? "";
        if (typeof note !== "string") throw bad(name, "the note must be text");
        const same = old && old.base === base && old.words === words && old.as === as;
        const known = same ? old : { certainty: "unconfirmed", writable: false };
        const sure = confirmed ? { certainty: "certain", writable: true } : known;
        if (writable && !sure.writable) throw bad(name, "it can be writable only if it is confirmed");
        return { certainty: sure.certainty, writable: sure.writable && writable !== false, note: note.slice(0, 100) };
      }
      var own = (row, key) => Object.hasOwn(row, key) ? row[key] : void 0;
      function flag(name, row, key) {
        const value = own(row, key);
        if (value !== void 0 && typeof value !== "boolean") throw bad(name, `"${key}" must be true or false`);
        return value;
      }
      function number(name, row, key, old) {
        const given = own(row, key);
        if ((given === void 0 || given === "") && old) return old[key];
        const text = typeof given === "string" ? given.trim().replace(/^\$/, "0x") : given;
        const value = typeof text === "string" && /^(0x[0-9a-f]{1,5}|\d{1,6})$/i.test(text) ? Number(text) : text;
        if (!Number.isInteger(value) || value < 0 || value > LAST_WORD + 1) {
          throw bad(name, `"${key}" must be a whole number from 0 to ${LAST_WORD}, or hex as in 0x1C0`);
        }
        return value;
      }
      var bad = (name, reason) => new PlcError("BAD_AREA", { name, reason });
      module.exports = { AREAS, LAST_BIT, LAST_WORD, areaMap };
    }
  });

  // lib/codec/nx/address.js
  var require_address2 = __commonJS({
    "lib/codec/nx/address.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { areaMap, LAST_BIT, LAST_WORD } = require_areas();
      var { functionOf, queryCode } = require_functions();
      var MOST_CHARACTERS = 64;
      var MOST_RANGE = 4096;
      var STANDARD = areaMap();
      var NOTATION = /^([A-Z]{1,4})(\d{1,8})(?:\.(\d{1,8}))?$/;
      var RAW = /^@(BIT:)?(0X[0-9A-F]{1,8}|\d{1,8})(?:\.(\d{1,8}))?$/;
      var hex = (value) => value.toString(16).toUpperCase().padStart(4, "0");
      function parseAddress(text, areas = STANDARD) {
        if (typeof text !== "string") throw new PlcError("BAD_ADDRESS", { address: text, reason: "it is not text" });
        const clean = text.trim();
        if (clean === "") throw bad(text, "it is empty");
        if (clean.length > MOST_CHARACTERS)
          throw bad(clean.slice(0, 20) + "…", `it has more than ${MOST_CHARACTERS} characters`);
        const [first, last, more] = clean.split(/\s*\.\.\s*/);
        if (more !== void 0) throw bad(clean, "a range has two ends");
        const from = parseOne(first, clean, areas);
        if (last === void 0) return finish(from, 1, areas);
        return range(from, parseOne(last, clean, areas), { clean, areas });
      }
      function range(from, to, { clean, areas }) {
        if (from.kind !== to.kind) throw bad(clean, "one end is a bit, the other a word");
        if (from.raw !== to.raw || !from.raw && from.row !== to.row) throw bad(clean, "both ends must lie in one area");
        const count = to.address - from.address + 1;
        if (count < 1) throw bad(clean, "the range runs backwards");
        if (count > MOST_RANGE) {
          const reason = "the range is too long";
          throw new PlcError("BAD_COUNT", { count, unit: `${from.kind}s`, reason, least: 1, most: MOST_RANGE });
        }
        return finish(from, count, areas);
      }
      function parseOne(part, whole, areas) {
        const upper = part.trim().toUpperCase();
        const raw = RAW.exec(upper);
        if (raw) return parseRaw(raw, whole);
        const found = NOTATION.exec(upper);
        if (!found)
          throw bad(
            whole,
            part === "" ? "one end of the range is missing" : "it is neither like M0 or K127.12 nor like @0x00C0"
          );
        const [, area, digits, bit] = found;
        const row = areas.get(area);
        if (!row) {
          throw new PlcError("UNKNOWN_AREA", { address: whole, area, known: areas.list.map((each) => each.area).join(", ") });
        }
        const number = Number(digits);
        if (row.as === "bits" && bit !== void 0) throw bad(whole, `${area} has contacts: a number without a bit`);
        const size = row.as === "bits" ? row.words * 16 : row.words;
        if (number >= size) throw new PlcError("OUT_OF_AREA", { address: whole, area, range: `${area}0..${area}${size - 1}` });
        if (row.as === "bits") return { kind: "bit", address: row.base * 16 + number, row, raw: false };
        if (bit === void 0) return { kind: "word", address: row.base + number, row, raw: false };
        return { kind: "bit", address: (row.base + number) * 16 + bitOf(bit, whole), row, raw: false };
      }
      function parseRaw(found, whole) {
        const [, isBit, digits, bit] = found;
        const number = Number(digits);
        const kind = isBit || bit !== void 0 ? "bit" : "word";
        if (isBit && bit !== void 0) throw bad(whole, "@bit: is followed by a bit address alone");
        const limit = isBit ? LAST_BIT : LAST_WORD;
        if (number > limit) throw bad(whole, `the last ${isBit ? "bit" : "word"} address is 0x${hex(limit)}`);
        const address = bit === void 0 ? number : number * 16 + bitOf(bit, whole);
        return { kind, address, row: null, raw: true };
      }
      function bitOf(digits, whole) {
        if (Number(digits) > 15) throw new PlcError("BAD_BIT", { address: whole, bit: Number(digits) });
        return Number(digits);
      }
      function finish({ kind, address, row, raw }, count, areas) {
        const place = raw ? covering({ kind, address, count }, areas) : row;
        const last = address + count - 1;
        const through = kind === "bit" && (last > LAST_BIT || !raw && row.as === "words");
        const result = {
          kind,
          address,
          count,
          area: place.area,
          raw,
          text: raw ? rawText(kind, address, count) : areaText(kind, address, count, row),
          writable: place.writable && !through,
          certainty: place.certainty
        };
        if (through) result.throughWord = { address: address >> 4, bit: address & 15, writable: place.writable };
        return result;
      }
      function covering({ kind, address, count }, areas) {
        const first = kind === "bit" ? address >> 4 : address;
        const last = kind === "bit" ? address + count - 1 >> 4 : address + count - 1;
        const rows = [];
        for (let word = first; word <= last; ) {
          const row = areas.at(word);
          if (!row) return { area: null, writable: false, certainty: "unconfirmed" };
          rows.push(row);
          word = row.base + row.words;
        }
        const certainty = ["unconfirmed", "likely", "certain"].find((each) => rows.some((row) => row.certainty === each));
        return { area: rows.length === 1 ? rows[0].area : null, writable: rows.every((row) => row.writable), certainty };
      }
      function rawText(kind, address, count) {
        const one = (at) => kind === "word" ? `@0x${hex(at)}` : `@0x${hex(at >> 4)}.${at & 15}`;
        return count === 1 ? one(address) : `${one(address)}..${one(address + count - 1)}`;
      }
      function areaText(kind, address, count, row) {
        const one = (at) => {
          if (kind === "word") return `${row.area}${at - row.base}`;
          return row.as === "bits" ? `${row.area}${at - row.base * 16}` : `${row.area}${(at >> 4) - row.base}.${at & 15}`;
        };
        return count === 1 ? one(address) : `${one(address)}..${one(address + count - 1)}`;
      }
      function formatAddress({ kind, address, count = 1 }, areas = STANDARD) {
        checkPlace(kind, address, count);
        const last = address + count - 1;
        const row = areas.at(kind === "bit" ? address >> 4 : address);
        const inside = row && areas.at(kind === "bit" ? last >> 4 : last) === row;
        if (!inside || kind === "word" && row.as === "bits") return rawText(kind, address, count);
        return areaText(kind, address, count, row);
      }
      function checkPlace(kind, address, count) {
        const limit = kind === "bit" ? LAST_WORD * 16 + 15 : LAST_WORD;
        const known = kind === "bit" || kind === "word";
        if (known && Number.isInteger(address) && Number.isInteger(count) && address >= 0 && count >= 1) {
          if (address + count - 1 <= limit) return;
        }
        throw bad(String(address), `no ${kind} has this absolute address`);
      }
      function describeAddress(place, { steps = 2, write = false } = {}) {
        const words = place.kind === "word" || place.throughWord !== void 0;
        const row = functionOf(`${write ? "write" : "read"}${words ? "Words" : "Bits"}`);
        const code = hex(queryCode(row, steps)).slice(2);
        const last = place.address + place.count - 1;
        if (!words) return `function ${code}, ${span("bit", place.address, last)}`;
        const first = place.throughWord ? place.throughWord.address : place.address;
        const end = place.throughWord ? last >> 4 : last;
        const decimal = first === end ? `(${first})` : `(${first}–${end})`;
        const bit = !place.throughWord ? "" : place.count === 1 ? `, bit ${place.throughWord.bit}` : `, ${place.count} bits`;
        return `function ${code}, ${span("word", first, end)} ${decimal}${bit}`;
      }
      var span = (unit, first, last) => first === last ? `${unit} address ${hex(first)}h` : `${unit} addresses ${hex(first)}h–${hex(last)}h`;
      var bad = (address, reason) => new PlcError("BAD_ADDRESS", { address, reason });
      module.exports = { parseAddress, formatAddress, describeAddress };
    }
  });

  // lib/tag/nx-notation.js
  var require_nx_notation = __commonJS({
    "lib/tag/nx-notation.js"(exports, module) {
      "use strict";
      var { formatAddress, parseAddress } = require_address2();
      var { areaMap, LAST_WORD } = require_areas();
      var { readTags } = require_tags();
      var lastOf = (address, areas) => {
        const row = address.area === null ? void 0 : areas.get(address.area);
        const lastWord = row ? row.base + row.words - 1 : LAST_WORD;
        return address.kind === "word" ? lastWord : lastWord * 16 + 15;
      };
      var nxNotation = ({ areas: rows = [], tags, wordOrder = "low", byteOrder = "low" } = {}) => {
        const areas = areaMap(rows);
        const notation = {
          areas,
          parse: (text) => parseAddress(text, areas),
          format: (at) => formatAddress(at, areas),
          last: (address) => lastOf(address, areas),
          wordOrder,
          byteOrder
        };
        return { ...notation, tags: readTags(tags, notation) };
      };
      module.exports = { nxNotation };
    }
  });

  // scripts/editor/texts.js
  var require_texts = __commonJS({
    "scripts/editor/texts.js"(exports, module) {
      "use strict";
      var SHARED = "@nxline/node-red-serial-plc/plc-line:";
      var t = (key, values) => RED._(`${SHARED}${key}`, values);
      var translate = (key, values, text) => {
        const translated = RED._(`${SHARED}${key}`, { ...values, defaultValue: text });
        return /__\w+__/.test(translated) ? text : translated;
      };
      var errorText = (error) => {
        const text = String(error.message || error);
        const { code, details } = error;
        if (!code || !details) return text;
        const { why, notation, reason } = details;
        const values = why ? { ...details, reason: translate(`why.${why}`, details, reason) } : details;
        const general = translate(`error.${code}`, values, text);
        return notation ? translate(`error.${code}_${notation.toUpperCase()}`, values, general) : general;
      };
      var causeText = ({ code, text, remedy, details }) => translate(`cause.${code}`, details || {}, `${capital(text)}. ${remedy}`);
      var capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);
      var reasonOf = (error) => errorText(error.cause && error.cause.code ? error.cause : error);
      module.exports = { t, capital, causeText, errorText, reasonOf };
    }
  });

  // scripts/editor/model.js
  var require_model = __commonJS({
    "scripts/editor/model.js"(exports, module) {
      "use strict";
      var { functionOf, queryCode } = require_functions();
      var { TABLES, placeOf } = require_address();
      var { readFunction, writeFunction } = require_functions2();
      var { parseItem } = require_item();
      var { modbusNotation } = require_modbus_notation();
      var { nxNotation } = require_nx_notation();
      var { t } = require_texts();
      var attempt = (make, otherwise) => {
        try {
          return make();
        } catch {
          return otherwise;
        }
      };
      var hex = (value, digits) => value.toString(16).toUpperCase().padStart(digits, "0");
      var unitOf = (item, bits) => {
        const number = item.kind === "word" ? item.count * item.type.words : item.count;
        if (item.throughWord) return t("editor.through");
        if (number === 1) return t(bits ? "editor.bit" : "editor.word");
        return t(bits ? "editor.bits" : "editor.words", { number });
      };
      var describeNx = (item, { steps = 2 }, write) => {
        const bits = item.kind === "bit" && !item.throughWord;
        const row = functionOf((write ? "write" : "read") + (bits ? "Bits" : "Words"));
        const code = hex(queryCode(row, String(steps) === "4" ? 4 : 2), 2);
        const address = hex(item.throughWord ? Math.floor(item.address / 16) : item.address, 4);
        return t("editor.goesOut", { code, address, what: unitOf(item, bits) });
      };
      var lengthOf = ({ kind, count, type, packed }) => count * (kind === "word" || packed ? type.words : 1) * (packed ? 16 : 1);
      var SINGLE = { "05": () => true, "06": () => true, auto: (count) => count === 1 };
      var writeCode = (table, count, { coilFunction = "0F", holdingFunction = "10" }) => {
        const chosen = table === "co" ? coilFunction : holdingFunction;
        const single = SINGLE[chosen] ? SINGLE[chosen](count) : false;
        return hex(writeFunction(table, { single }), 2);
      };
      var whereOf = (first, last) => {
        const values = { first, last, firstHex: hex(first, 4), lastHex: hex(last, 4) };
        return t(first === last ? "editor.wire" : "editor.wires", values);
      };
      var isWritable = (table) => TABLES.find((row) => row.table === table).writable;
      var canOnlyBeRead = (item, { type }) => type === "chino-config" && !isWritable(placeOf(item.kind, item.address).table);
      var describeModbus = (item, device, write) => {
        const length = lengthOf(item);
        const { table, wire, bit } = placeOf(item.kind, item.address);
        const last = placeOf(item.kind, item.address + length - 1).wire;
        const where = whereOf(wire, last);
        const read = hex(readFunction(table), 2);
        if (write && !isWritable(table)) return t("editor.readable");
        const code = write ? writeCode(table, last - wire + 1, device) : read;
        if (bit === void 0) return t("editor.sent", { code, where });
        if (write) return t("editor.changed", { read, code, where });
        const bits = length === 1 ? t("editor.oneBit", { number: bit }) : t("editor.severalBits", { number: length });
        return `${t("editor.sent", { code, where })}, ${bits}`;
      };
      var oneOf = (value, known) => known.includes(value) ? value : known[0];
      var DEVICES = {
        "nx-config": {
          label: "editor.station",
          notation: ({ areas }, tags) => nxNotation({ areas: areas || [], tags }),
          // faulty area rows count as none
          usable: (device) => ({ areas: attempt(() => nxNotation({ areas: device.areas || [] }) && device.areas, []) || [] }),
          describe: describeNx
        },
        "chino-config": {
          label: "editor.regulator",
          notation: ({ addressMode, wordOrder }, tags) => modbusNotation({
            addressMode: oneOf(addressMode, ["1-base", "0-base"]),
            wordOrder: oneOf(wordOrder, ["low", "high"]),
            tags
          }),
          usable: (device) => device,
          describe: describeModbus
        }
      };
      var TYPES = Object.keys(DEVICES);
      var kindOf = (device) => DEVICES[device && device.type || "nx-config"] || DEVICES["nx-config"];
      var notationOf = (device) => kindOf(device).notation(device || {});
      var usableTags = (notation, device, tags) => {
        const names = /* @__PURE__ */ new Set();
        return tags.filter((row) => {
          const [name] = attempt(() => [...notation(device, [row]).tags.keys()], []);
          return name !== void 0 && !names.has(name) && names.add(name);
        });
      };
      var notationWithTags = (device) => {
        const { notation, usable } = kindOf(device);
        const own = usable(device || {});
        const tags = device && device.tags || [];
        return attempt(() => notation(own, tags), null) || notation(own, usableTags(notation, own, Array.isArray(tags) ? tags : []));
      };
      var deviceLabel = (device) => t(kindOf(device).label, { station: device.station === "" ? "?" : device.station });
      var deviceName = (device) => device.name || deviceLabel(device);
      var describe = (item, device, { write = false } = {}) => kindOf(device).describe(item, device || {}, write);
      var unsure = (item, notation) => attempt(() => notation.parse(item.addressText).certainty === "unconfirmed", false);
      module.exports = {
        TYPES,
        notationOf,
        notationWithTags,
        deviceLabel,
        deviceName,
        describe,
        unsure,
        parseItem,
        attempt,
        canOnlyBeRead,
        hex
      };
    }
  });

  // scripts/editor/line-use.js
  var require_line_use = __commonJS({
    "scripts/editor/line-use.js"(exports, module) {
      "use strict";
      var { LISTENERS, portConflict } = require_listening_rules();
      var { PROPERTIES } = require_properties();
      var { TYPES, deviceName } = require_model();
      var { t } = require_texts();
      var nameOf = (node) => node.name || LISTENERS[node.type].title;
      var listenersOn = (line) => {
        const found = [];
        RED.nodes.eachNode((node) => {
          if (LISTENERS[node.type] && node.line === line && !node.d) found.push(node);
          return true;
        });
        return found;
      };
      var listenerOf = (line) => {
        const [first] = line ? listenersOn(line) : [];
        return first ? nameOf(first) : "";
      };
      var settingsOf = (type, read) => Object.fromEntries(Object.keys(PROPERTIES[type]).map((name) => [name, read(name)]));
      var lineOfListener = (node, read) => {
        const line = read("line");
        let polled = "";
        RED.nodes.eachConfig((other) => {
          if (TYPES.includes(other.type) && other.line === line && !other.d) polled = polled || deviceName(other);
          return true;
        });
        if (polled) return t("problem.polled", { other: polled });
        const own = { type: node.type, settings: settingsOf(node.type, read) };
        for (const other of listenersOn(line)) {
          if (other.id === node.id) continue;
          const reason = portConflict(own, { type: other.type, settings: other });
          if (reason) return t("problem.otherCut", { other: nameOf(other), reason });
        }
        return true;
      };
      module.exports = { lineOfListener, listenerOf };
    }
  });

  // scripts/editor/widgets.js
  var require_widgets = __commonJS({
    "scripts/editor/widgets.js"(exports, module) {
      "use strict";
      var { t } = require_texts();
      var tabs = (id, pages) => {
        const widget = RED.tabs.create({
          id,
          onchange(tab) {
            $(`#${id}-content`).children().hide();
            $(`#${tab.id}`).show();
            $(`#${tab.id}`).trigger("nxline-shown");
          }
        });
        pages.forEach(([page, label]) => widget.addTab({ id: page, label }));
        return widget;
      };
      var keepUnknown = (field, value) => {
        if (value === void 0 || value === null || value === "") return;
        const known = field.find("option").filter((_, option) => option.value === String(value)).length > 0;
        if (!known) field.append($("<option>").attr("value", value).text(value));
        field.val(String(value));
      };
      var fillDefaults = (node, prefix) => {
        for (const [name, { value }] of Object.entries(node._def.defaults)) {
          const field = $(`#${prefix}${name}`);
          if (field.length === 0) continue;
          if (node[name] === void 0 && value !== "" && !Array.isArray(value)) {
            if (field.is(":checkbox")) field.prop("checked", value);
            else field.val(String(value));
          }
          if (field.is("select") && !field.prop("multiple") && !name.match(/^(line|plc|regulator)$/)) {
            keepUnknown(field, node[name] === void 0 ? value : node[name]);
          }
        }
      };
      var offerRow = ({ value, hint = "", first = "" }) => ({
        value,
        label: $("<span>").text(first || value).append(
          $("<span>").css({ color: "var(--red-ui-secondary-text-color)", marginLeft: "8px" }).text(first ? value : hint)
        )
      });
      var offersFor = (text, offers, usable) => {
        const wanted = text.trim().toLowerCase();
        const found = offers.filter((offer) => `${offer.value} ${offer.hint || ""} ${offer.first || ""}`.toLowerCase().includes(wanted)).slice(0, 50);
        if (wanted === "" || found.length === 0 || !usable(text.trim())) return found;
        const others = found.filter(({ value }) => value !== text.trim());
        return others.length === 0 ? [] : [{ value: text.trim() }, ...others];
      };
      var suggest = (field, offers, usable) => {
        field.on("keydown", ({ key }) => {
          const before = field.val();
          if (key === "Tab" || key === "Enter") setTimeout(() => field.val() !== before && field.trigger("change"), 0);
        });
        field.autoComplete({
          minLength: 0,
          search: (value, answer) => answer(offersFor(value, offers(), usable).map(offerRow))
        });
        field.on("click", () => field.val() === "" && field.trigger("keyup"));
      };
      var copyable = (text) => $('<a href="#" class="nxline-copy">').css({ fontFamily: "var(--red-ui-monospace-font)", whiteSpace: "nowrap" }).attr("title", t("editor.copy")).text(text).prepend('<i class="fa fa-clipboard" style="margin-right: 4px"></i>').on("click", function(event) {
        event.preventDefault();
        RED.clipboard.copyText(text, $(this));
      });
      var note = () => $('<div class="nxline-note">').css({
        fontSize: "12px",
        lineHeight: "16px",
        minHeight: "16px",
        color: "var(--red-ui-secondary-text-color)"
      });
      var say = (block, text, bad = false) => block.empty().text(text).css("color", bad ? "var(--red-ui-text-color-error)" : "var(--red-ui-secondary-text-color)");
      var cell = (name, value, { width = "80px", grow = false, shows = t(`column.${name}`), hint = t(`tooltip.${name}`) } = {}) => $('<input type="text">').addClass(`nxline-${name}`).attr({ placeholder: shows, title: hint, "aria-label": t(`column.${name}`) }).css({ width, flexGrow: grow ? 1 : 0, minWidth: 0, margin: 0 }).val(value === void 0 || value === null ? "" : String(value));
      var pick = (name, value, options) => {
        const field = $("<select>").addClass(`nxline-${name}`).attr({ title: t(`tooltip.${name}`), "aria-label": t(`column.${name}`) }).css({ width: "auto", margin: 0 });
        options.forEach(([key, label]) => field.append($("<option>").attr("value", key).text(label)));
        keepUnknown(field, value);
        return field;
      };
      var truthy = (value) => Boolean(value) && value !== "false";
      var tick = (name, value) => {
        const box = $('<input type="checkbox">').addClass(`nxline-${name}`).css({ width: "auto", margin: "0 4px 0 0" }).prop("checked", truthy(value));
        const label = $("<label>").css({ width: "auto", margin: 0, display: "inline-flex", alignItems: "center", whiteSpace: "nowrap" }).attr("title", t(`tooltip.${name}`)).append(box).append(document.createTextNode(t(`column.${name}`)));
        return { box, label };
      };
      var mark = (text) => $("<span>").css({ color: "var(--red-ui-secondary-text-color)", whiteSpace: "nowrap", fontSize: "12px" }).text(text);
      var flex = (...children) => $("<div>").css({ display: "flex", gap: "4px", alignItems: "center", marginBottom: "3px" }).append(children);
      module.exports = { tabs, fillDefaults, suggest, offersFor, copyable, note, say, cell, pick, tick, truthy, flex, mark };
    }
  });

  // lib/device/options.js
  var require_options = __commonJS({
    "lib/device/options.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var TURNAROUND = 5;
      var blank = (value) => value === void 0 || value === null || typeof value === "string" && value.trim() === "";
      var textOf = (setting, value) => {
        if (!["object", "function", "symbol"].includes(typeof value)) return String(value).trim();
        throw new PlcError("BAD_SETTING", { setting, value, reason: "text is needed" });
      };
      var wholeNumber = (setting, value, { fallback, least, most }) => {
        if (blank(value)) return fallback;
        const number = typeof value === "string" ? Number(value) : value;
        if (Number.isInteger(number) && number >= least && number <= most) return number;
        throw new PlcError("BAD_SETTING", { setting, value, reason: `a whole number from ${least} to ${most} is needed` });
      };
      var choice = (setting, value, known) => {
        if (blank(value)) return known[0];
        const found = known.find((each) => String(each) === textOf(setting, value));
        if (found !== void 0) return found;
        throw new PlcError("BAD_SETTING", { setting, value, reason: `known are ${known.join(", ")}` });
      };
      var nameOf = (value, station) => blank(value) ? `station ${station}` : textOf("name", value);
      var readRanges = (value, notation) => {
        const given = Array.isArray(value) ? value : blank(value) ? [] : textOf("writableRanges", value).split(",");
        return given.map((text) => textOf("writableRanges", text)).filter((text) => text !== "").map((text) => {
          const { kind, address, count } = notation.parse(text);
          const size = kind === "word" ? 16 : 1;
          return { start: address * size, end: (address + count) * size };
        });
      };
      var isOn = (value) => value === true || value === "true";
      var readHealth = (given) => {
        const demoteAfter = wholeNumber("demoteAfter", given.demoteAfter, { fallback: 3, least: 0, most: 100 });
        const probeFirst = wholeNumber("probeFirst", given.probeFirst, { fallback: 5e3, least: 100, most: 36e5 });
        const fallback = Math.max(6e4, probeFirst);
        const probeMost = wholeNumber("probeMost", given.probeMost, { fallback, least: 100, most: 36e5 });
        if (probeMost >= probeFirst) return { demoteAfter, probeFirst, probeMost };
        const reason = `it is less than the time until the first probe, ${probeFirst}`;
        throw new PlcError("BAD_SETTING", { setting: "probeMost", value: probeMost, reason });
      };
      module.exports = { TURNAROUND, blank, choice, isOn, nameOf, readHealth, readRanges, textOf, wholeNumber };
    }
  });

  // lib/device/mixed.js
  var require_mixed = __commonJS({
    "lib/device/mixed.js"(exports, module) {
      "use strict";
      var ONLY_PLC = 255;
      var conflict = (nx, modbus) => {
        const { station } = modbus;
        if (nx.station === ONLY_PLC) return `NX station ${ONLY_PLC} answers to every number`;
        if (nx.station === 0) return "NX station 0 is the broadcast of MODBUS";
        if (station === 0) return "a MODBUS broadcast reaches the NX PLCs too";
        if (nx.station === station) return `both are station ${station}`;
        if ((nx.masterIds ?? []).includes(station)) {
          return `the NX configuration sends as master ID ${station}, which is the number of the regulator`;
        }
        return "";
      };
      var mixedConflict = (one, other) => {
        if (one.protocol === other.protocol) return "";
        return one.protocol === "nx" ? conflict(one, other) : conflict(other, one);
      };
      module.exports = { mixedConflict };
    }
  });

  // lib/codec/nx/ids.js
  var require_ids = __commonJS({
    "lib/codec/nx/ids.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var LEAST_FREE = 192;
      var LAST = 254;
      var DEFAULT_IDS = Object.freeze([226, 227, 228, 229, 230, 231, 232, 233]);
      function masterIdList(value, { stations = [] } = {}) {
        if (value === void 0 || value === null || value === "") return DEFAULT_IDS;
        const given = Array.isArray(value) ? value : typeof value === "string" ? value.split(",").flatMap(expand) : [value];
        if (given.length < 1 || given.length > LAST + 1) throw bad(value, "give 1 to 255 numbers");
        const ids = [...new Set(given)];
        for (const id of ids) checkId(id, stations);
        return Object.freeze(ids);
      }
      function checkId(id, stations) {
        if (!Number.isInteger(id) || id < 0 || id > LAST) throw bad(id, "it must be a whole number from 0 to 254");
        if (id >= LEAST_FREE) return;
        if (stations.includes(id)) throw bad(id, "a station of this line has this number");
        if (stations.includes(255)) throw bad(id, "with station 255 the number of the PLC is not known");
      }
      function expand(text) {
        const ends = text.split("..").map((part) => {
          const clean = part.trim().replace(/^\$/, "0x");
          if (!/^(0x[0-9a-f]{1,2}|\d{1,3})$/i.test(clean)) throw bad(text.trim(), "it is not a number");
          return Number(clean);
        });
        const [first, last = first] = ends;
        if (ends.length > 2 || last < first || last > 255) throw bad(text.trim(), "it is not a range");
        return Array.from({ length: last - first + 1 }, (_, i) => first + i);
      }
      var bad = (id, reason) => new PlcError("BAD_MASTER_ID", { id: shown(id), reason });
      var shown = (id) => {
        try {
          return String(id);
        } catch {
          return typeof id;
        }
      };
      function masterIds({ ids = DEFAULT_IDS, start = 0, memory = {} } = {}) {
        if (!Array.isArray(memory.resting)) memory.resting = [];
        const resting = memory.resting;
        const first = Math.abs(Math.trunc(start)) % ids.length || 0;
        const following = () => {
          const remembered = ids.indexOf(memory.last ?? -1);
          return remembered >= 0 ? (remembered + 1) % ids.length : first;
        };
        const free = (id) => {
          if (resting.length === 0) return;
          const at = id === void 0 ? -1 : resting.indexOf(id);
          if (id === void 0) resting.length = 0;
          else if (at >= 0) resting.splice(at, 1);
        };
        return {
          /** @returns {number} the ID of the next query */
          take() {
            let next = following();
            if (resting.length === 0) return memory.last = ids[next];
            let tries = ids.length;
            while (tries-- > 0 && resting.includes(ids[next])) next = (next + 1) % ids.length;
            const oldest = resting.find((id2) => ids.includes(id2));
            const id = tries < 0 && oldest !== void 0 ? oldest : ids[next];
            memory.last = id;
            return id;
          },
          /** The exchange of this ID ended with an answer. @param {number} id */
          ok: (id) => free(id),
          /** It did not: an answer may still come. @param {number} id */
          failed(id) {
            free(id);
            if (ids.length > 1) resting.push(id);
          },
          /** No answer can come any more: to this ID, or to any. @param {number} [id] */
          free,
          /** @returns {number[]} IDs to which an answer may still come */
          resting: () => [...resting],
          ids
        };
      }
      module.exports = { DEFAULT_IDS, masterIdList, masterIds };
    }
  });

  // lib/codec/crc16.js
  var require_crc16 = __commonJS({
    "lib/codec/crc16.js"(exports, module) {
      "use strict";
      var POLYNOMIAL = 40961;
      var START = 65535;
      var TABLE = Uint16Array.from({ length: 256 }, (_, byte) => {
        let crc = byte;
        for (let bit = 0; bit < 8; bit++) crc = crc & 1 ? crc >>> 1 ^ POLYNOMIAL : crc >>> 1;
        return crc;
      });
      function crc16(bytes, start = 0, end = bytes.length) {
        let crc = START;
        for (let i = start; i < end; i++) crc = crc >>> 8 ^ TABLE[(crc ^ bytes[i]) & 255];
        return crc;
      }
      module.exports = { crc16 };
    }
  });

  // lib/codec/nx/frame.js
  var require_frame = __commonJS({
    "lib/codec/nx/frame.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { crc16 } = require_crc16();
      var HEADER = 4;
      var OVERHEAD = 6;
      var MOST_INFO = 256;
      var SHORTEST = OVERHEAD + 1;
      var LONGEST = OVERHEAD + MOST_INFO;
      function encodeFrame({ to, from, fn, info }) {
        byte("to", to);
        byte("from", from);
        byte("fn", fn);
        const length = info.length;
        if (!(length >= 1))
          throw new PlcError("BAD_SETTING", { setting: "info", value: "empty", reason: "LEN 0 means 256 bytes" });
        if (length > MOST_INFO) throw new PlcError("FRAME_TOO_LONG", { what: "INFO", got: length, most: MOST_INFO });
        const bytes = Buffer.allocUnsafe(length + OVERHEAD);
        bytes[0] = to;
        bytes[1] = from;
        bytes[2] = fn;
        bytes[3] = length & 255;
        bytes.set(info, HEADER);
        bytes.writeUInt16LE(crc16(bytes, 0, length + HEADER), length + HEADER);
        return bytes;
      }
      function byte(setting, value) {
        if (!Number.isInteger(value) || value < 0 || value > 255) {
          throw new PlcError("BAD_SETTING", { setting, value, reason: "it must be a byte, 0 to 255" });
        }
      }
      function frameLength(bytes, start = 0) {
        return bytes.length - start < HEADER ? 0 : (bytes[start + 3] || MOST_INFO) + OVERHEAD;
      }
      function crcFits(bytes, start, length) {
        const end = start + length - 2;
        return crc16(bytes, start, end) === (bytes[end] | bytes[end + 1] << 8);
      }
      function decodeFrame(bytes, start = 0) {
        const length = frameLength(bytes, start);
        return length > 0 && bytes.length - start >= length && crcFits(bytes, start, length) ? openFrame(bytes, start) : null;
      }
      function openFrame(bytes, start = 0) {
        const length = frameLength(bytes, start);
        const info = Buffer.from(bytes.buffer, bytes.byteOffset + start + HEADER, length - OVERHEAD);
        return { to: bytes[start], from: bytes[start + 1], fn: bytes[start + 2], info, length };
      }
      module.exports = {
        SHORTEST,
        LONGEST,
        MOST_INFO,
        HEADER,
        OVERHEAD,
        encodeFrame,
        frameLength,
        crcFits,
        decodeFrame,
        openFrame
      };
    }
  });

  // lib/codec/nx/limits.js
  var require_limits = __commonJS({
    "lib/codec/nx/limits.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { functionOf } = require_functions();
      var { MOST_INFO } = require_frame();
      var LIMITS = Object.freeze({
        readBits: 255,
        writeBits: 254,
        readWords: 128,
        writeWords: 64,
        readMixed: 128,
        writeMixed: 85,
        info: MOST_INFO
      });
      var LAST_MIXED = 16383;
      var LAST = 65535;
      function limitsOf(settings = {}) {
        const limits = { ...LIMITS };
        for (const [name, given] of Object.entries(settings ?? {})) {
          if (given === void 0) continue;
          if (!Object.hasOwn(LIMITS, name)) {
            throw new PlcError("BAD_SETTING", { setting: `limits.${name}`, value: given, reason: "there is no such limit" });
          }
          const least = name === "info" ? 3 : 1;
          const most = name === "info" ? MOST_INFO : functionOf(name).most;
          const value = typeof given === "string" && /^\s*\d{1,3}\s*$/.test(given) ? Number(given) : given;
          if (!Number.isInteger(value) || value < least || value > most) {
            throw new PlcError("BAD_SETTING", {
              setting: `limits.${name}`,
              value: given,
              reason: `it must be ${least} to ${most}`
            });
          }
          limits[name] = value;
        }
        return Object.freeze(limits);
      }
      function check(query, limits = LIMITS) {
        const row = functionOf(query?.ask);
        CHECKS[row.name](query, row, limits);
        return row;
      }
      var CHECKS = {
        readBits: checkBlock,
        readWords: checkBlock,
        writeBits: (query, row, limits) => checkBlockWrite("bit", query, { row, limits }),
        writeWords: (query, row, limits) => checkBlockWrite("word", query, { row, limits }),
        readMixed({ addresses }, row, limits) {
          const list = listOf(addresses, row, limits);
          list.forEach(checkPlace);
          checkBytes(list.length * 2, limits);
        },
        writeMixed({ writes }, row, limits) {
          const list = listOf(writes, row, limits);
          list.forEach(checkPlace);
          list.forEach(({ kind, address, value }) => checkValue(kind, address, value));
          const bytes = list.reduce((sum, { kind }) => sum + (kind === "bit" ? 3 : 4), 0);
          checkBytes(bytes, limits);
        }
      };
      function checkBlockWrite(kind, { base, values }, { row, limits }) {
        const list = listOf(values, row, limits);
        checkBlock({ base, count: list.length }, row, limits);
        list.forEach((value, i) => checkValue(kind, base + i, value));
      }
      function checkBlock({ base, count }, row, limits) {
        checkCount(count, row, limits);
        const kind = row.unit === "bits" ? "bit" : "word";
        if (!whole(base, LAST)) throw badAddress(base, `the last ${kind} address is ${LAST}`);
        if (base + count - 1 > LAST)
          throw badAddress(base, `${count} ${row.unit} from there end after the last address ${LAST}`);
        const size = kind === "bit" ? count : count * 2;
        checkBytes(row.repeatable ? Math.max(size, 3) : size + 2, limits);
      }
      function checkCount(count, row, limits) {
        const most = limits[row.name];
        if (whole(count, most) && count >= 1) return;
        const reason = count === 0 ? "there is nothing to ask for" : whole(count, Infinity) ? "too many for one frame" : "no count";
        throw new PlcError("BAD_COUNT", { count, unit: row.unit, reason, least: 1, most });
      }
      function checkBytes(got, limits) {
        if (got > limits.info)
          throw new PlcError("FRAME_TOO_LONG", { what: "the query or its answer", got, most: limits.info });
      }
      function checkPlace(place) {
        const kind = place?.kind;
        if (kind !== "bit" && kind !== "word") throw badAddress(place?.address, "it must be a bit or a word");
        if (!whole(place.address, LAST_MIXED))
          throw badAddress(place.address, `in mixed frames the last ${kind} address is ${LAST_MIXED}`);
      }
      function checkValue(kind, address, value) {
        if (kind === "bit" ? typeof value === "boolean" : whole(value, 65535)) return;
        const reason = kind === "bit" ? "a bit is true or false" : "a word is a whole number from 0 to 65535";
        throw new PlcError("BAD_VALUE", { item: `${kind} ${hex(address)}`, value: String(value), reason });
      }
      function listOf(list, row, limits) {
        if (Array.isArray(list)) {
          checkCount(list.length, row, limits);
          return Array.from(list);
        }
        const reason = "they are not given as a list";
        throw new PlcError("BAD_COUNT", { count: "no", unit: row.unit, reason, least: 1, most: limits[row.name] });
      }
      var whole = (value, most) => Number.isInteger(value) && value >= 0 && value <= most;
      var hex = (value) => `${value.toString(16).toUpperCase().padStart(4, "0")}h`;
      var badAddress = (address, reason) => new PlcError("BAD_ADDRESS", { address: String(address), reason });
      module.exports = { LIMITS, limitsOf, check };
    }
  });

  // lib/plan/mixed.js
  var require_mixed2 = __commonJS({
    "lib/plan/mixed.js"(exports, module) {
      "use strict";
      var LAST_MIXED = 16383;
      var wordsOf = ({ start, end }) => ({ start: start >> 4, end: (end - 1 >> 4) + 1 });
      var addAll = (addresses, { start, end }) => {
        for (let address = start; address < end; address++) addresses.add(address);
      };
      var askedOf = (groups, isJoint) => {
        const words = /* @__PURE__ */ new Set();
        const bits = /* @__PURE__ */ new Set();
        const single = [];
        const seen = /* @__PURE__ */ new Set();
        for (const group of groups) {
          const span = group.kind === "word" ? group : wordsOf(group);
          if (group.kind === "word") addAll(words, span);
          else if (!isJoint(span)) addAll(bits, group);
          else if (group.end - group.start > 1) addAll(words, span);
          else {
            single.push(group.start);
            if (seen.has(span.start) || group.start > LAST_MIXED) words.add(span.start);
            seen.add(span.start);
          }
        }
        for (const bit of single) if (!words.has(bit >> 4)) bits.add(bit);
        return { bits, words };
      };
      var canName = (addresses) => {
        for (const address of addresses) if (address > LAST_MIXED) return false;
        return true;
      };
      var sizeOf = ({ bits, words }) => ({ count: bits.size + words.size, answer: bits.size + 2 * words.size });
      var fits = ({ bits, words }, most) => bits.size + words.size <= most && canName(bits) && canName(words);
      var append = (list, kind, addresses) => {
        for (const address of Float64Array.from(addresses).sort()) list.push({ kind, address });
      };
      var addressesOf = ({ bits, words }) => {
        const list = [];
        append(list, "bit", bits);
        append(list, "word", words);
        return list;
      };
      var BIT = { count: 1, answer: 1 };
      var WORD = { count: 1, answer: 2 };
      var shareOfOne = ({ space, start, groups }) => {
        const group = groups[0];
        const isSingle = groups.length === 1 && group.kind === "bit" && group.end - group.start === 1;
        if (isSingle && group.start <= LAST_MIXED) return BIT;
        return space === "word" && start <= LAST_MIXED ? WORD : null;
      };
      var areWords = (groups) => {
        for (const { kind } of groups) if (kind !== "word") return false;
        return true;
      };
      var shareOfWords = ({ start, end }, most) => {
        const count = end - start;
        return count <= most && end - 1 <= LAST_MIXED ? { count, answer: 2 * count } : null;
      };
      var shareOf = (chunk, { most, isJoint }) => {
        if (chunk.end - chunk.start === 1) return most > 0 ? shareOfOne(chunk) : null;
        if (areWords(chunk.groups)) return shareOfWords(chunk, most);
        const asked = askedOf(chunk.groups, isJoint);
        return fits(asked, most) ? sizeOf(asked) : null;
      };
      module.exports = { LAST_MIXED, addressesOf, askedOf, fits, shareOf, sizeOf, wordsOf };
    }
  });

  // lib/plan/model.js
  var require_model2 = __commonJS({
    "lib/plan/model.js"(exports, module) {
      "use strict";
      var { addressesOf, askedOf, fits, shareOf, sizeOf, wordsOf } = require_mixed2();
      var FRAME_COST = 60;
      var sortedSpans = (spans) => [...spans].sort((a, b) => a.start - b.start);
      var firstAbove = (sorted, value) => {
        let low = 0;
        let high = sorted.length;
        while (low < high) {
          const middle = low + high >> 1;
          if (sorted[middle] > value) high = middle;
          else low = middle + 1;
        }
        return low;
      };
      var SIZE = { bit: 16, word: 1 };
      var rulesOf = (kind, { bounds = [], holes = [] }) => ({
        bounds: [...new Set(bounds)].map((bound) => bound * SIZE[kind]).sort((a, b) => a - b),
        holes: sortedSpans(holes.filter((hole) => hole.kind === kind))
      });
      var joined = (intervals) => {
        const all = [];
        for (const [from, to] of [...intervals].sort((a, b) => a[0] - b[0])) {
          const last = all.at(-1);
          if (last && from <= last[1]) last[1] = Math.max(last[1], to);
          else all.push([from, to]);
        }
        return all;
      };
      var spanIn = (kind, group) => group.kind === kind ? group : wordsOf(group);
      var extentOf = (kind, groups) => {
        let start = Infinity;
        let end = -Infinity;
        for (const group of groups) {
          const span = spanIn(kind, group);
          start = Math.min(start, span.start);
          end = Math.max(end, span.end);
        }
        return { kind, start, end };
      };
      var QUERY = 3;
      var _limits, _rules, _joint, _sharing, _Model_instances, sizeOf_fn, crosses_fn, prices_fn, bridges_fn, block_fn, asWords_fn, asBits_fn, asMixed_fn;
      var Model = class {
        /** @param {import('./reads').Limits} limits */
        constructor(limits) {
          __privateAdd(this, _Model_instances);
          __privateAdd(this, _limits);
          __privateAdd(this, _rules);
          __privateAdd(this, _joint);
          __privateAdd(this, _sharing);
          /** Whether these words and their bits are one memory. @param {{ start: number, end: number }} span */
          __publicField(this, "isJoint", ({ start, end }) => {
            for (const span of __privateGet(this, _joint)) if (span[0] <= start && end <= span[1]) return true;
            return false;
          });
          const { readBits, readWords, readMixed, info, again, frameCost = FRAME_COST } = limits;
          __privateSet(this, _limits, limits);
          __privateSet(this, _joint, joined(limits.joint ?? []));
          __privateSet(this, _rules, { bit: rulesOf("bit", limits), word: rulesOf("word", limits) });
          this.most = { bit: Math.min(readBits, info), word: Math.min(readWords, info >> 1) };
          this.mostMixed = Math.min(readMixed, info >> 1);
          __privateSet(this, _sharing, { most: this.mostMixed, isJoint: this.isJoint });
          this.repeats = again !== void 0;
          this.frameCost = frameCost;
          this.repeatCost = again ?? Infinity;
          this.queryOfBlock = QUERY;
        }
        /** What a block costs, both ways. @param {'bit'|'word'} kind @param {number} count */
        blockCost(kind, count) {
          return this.frameCost + QUERY + __privateMethod(this, _Model_instances, sizeOf_fn).call(this, kind, count);
        }
        /** Whether what lies between two values may be read with them: nobody asked for it. @param {'bit'|'word'} kind */
        mayBridge(kind, from, to) {
          if (from >= to) return true;
          if (__privateGet(this, _limits).bridge === false) return false;
          for (const { start, end } of __privateGet(this, _rules)[kind].holes) if (start < to && from < end) return false;
          return true;
        }
        /** The first border after an address: areas need not be one memory. @param {'bit'|'word'} kind @param {number} start */
        borderAfter(kind, start) {
          const { bounds } = __privateGet(this, _rules)[kind];
          return bounds[firstAbove(bounds, start)] ?? Infinity;
        }
        /** What a block costs at first and repeated. @param {{ kind: 'bit'|'word', start: number, end: number }} block */
        pricesOfBlock({ kind, start, end }) {
          return __privateMethod(this, _Model_instances, prices_fn).call(this, QUERY, __privateMethod(this, _Model_instances, sizeOf_fn).call(this, kind, end - start));
        }
        /** What values take in a mixed request: addresses and bytes of the answer; null: it cannot hold them. @param {any} chunk */
        mixedShare(chunk) {
          return shareOf(chunk, __privateGet(this, _sharing));
        }
        /** All the ways to read these values with one request. @param {Group[]} groups @returns {Frame[]} */
        frames(groups) {
          return (
            /** @type {any[]} */
            [__privateMethod(this, _Model_instances, asBits_fn).call(this, groups), __privateMethod(this, _Model_instances, asWords_fn).call(this, groups), __privateMethod(this, _Model_instances, asMixed_fn).call(this, groups)].filter(Boolean)
          );
        }
      };
      _limits = new WeakMap();
      _rules = new WeakMap();
      _joint = new WeakMap();
      _sharing = new WeakMap();
      _Model_instances = new WeakSet();
      sizeOf_fn = function(kind, count) {
        const { unit = 1, bitBytes = 1, scale = 1 } = __privateGet(this, _limits);
        return scale * (kind === "word" ? count * 2 : Math.ceil(Math.ceil(count / unit) * unit * bitBytes));
      };
      /** Whether a block goes over a border on which none of its values stands. */
      crosses_fn = function(kind, { start, end }, spans) {
        for (let border = this.borderAfter(kind, start); border < end; border = this.borderAfter(kind, border)) {
          if (!spans.some((span) => span.start < border && border < span.end)) return true;
        }
        return false;
      };
      /** What a frame costs at first and repeated. @param {number} query bytes of INFO @param {number} answer the same */
      prices_fn = function(query, answer) {
        const cost = this.frameCost + query + answer;
        return { cost, again: Math.min(cost, this.repeatCost + answer) };
      };
      /** Whether all that lies between these values may be read with them. @param {{ start: number, end: number }[]} spans in order */
      bridges_fn = function(kind, spans) {
        let { end } = spans[0];
        for (const span of spans) {
          if (!this.mayBridge(kind, end, span.start)) return false;
          end = Math.max(end, span.end);
        }
        return true;
      };
      block_fn = function(kind, groups) {
        const span = extentOf(kind, groups);
        if (span.end - span.start > this.most[kind]) return null;
        const spans = sortedSpans(groups.map((group) => spanIn(kind, group)));
        if (!__privateMethod(this, _Model_instances, bridges_fn).call(this, kind, spans) || __privateMethod(this, _Model_instances, crosses_fn).call(this, kind, span, spans)) return null;
        const through = (group) => group.kind !== kind;
        return { form: "block", span, groups, through, ...this.pricesOfBlock(span) };
      };
      asWords_fn = function(groups) {
        const possible = groups.every((group) => group.kind === "word" || this.isJoint(wordsOf(group)));
        return possible ? __privateMethod(this, _Model_instances, block_fn).call(this, "word", groups) : null;
      };
      asBits_fn = function(groups) {
        return groups.every(({ kind }) => kind === "bit") ? __privateMethod(this, _Model_instances, block_fn).call(this, "bit", groups) : null;
      };
      asMixed_fn = function(groups) {
        if (this.mostMixed < 2) return null;
        const asked = askedOf(groups, this.isJoint);
        const { count, answer } = sizeOf(asked);
        if (count < 2 || !fits(asked, this.mostMixed)) return null;
        const through = (group) => group.kind === "bit" && (group.end - group.start > 1 || asked.words.has(group.start >> 4)) && this.isJoint(wordsOf(group));
        return { form: "mixed", addresses: addressesOf(asked), groups, through, ...__privateMethod(this, _Model_instances, prices_fn).call(this, 2 * count, answer) };
      };
      var cycleCost = (frames) => {
        if (frames.length === 1) return frames[0].again;
        let total = 0;
        let most = 0;
        let second = 0;
        for (const { cost, again } of frames) {
          const saved = cost - again;
          total += cost;
          if (saved > most) [most, second] = [saved, most];
          else if (saved > second) second = saved;
        }
        return total - (most + second) / 2;
      };
      module.exports = { Model, cycleCost };
    }
  });

  // lib/plan/together.js
  var require_together = __commonJS({
    "lib/plan/together.js"(exports, module) {
      "use strict";
      var SHARE = 0.5;
      var together = (groups, msOf) => {
        let rest = [...groups].sort((a, b) => a.interval - b.interval);
        const parts = [];
        while (rest.length > 0) {
          const part = [rest[0]];
          const left = [];
          for (const group of rest.slice(1)) {
            if (msOf([...part, group]) <= SHARE * part[0].interval) part.push(group);
            else left.push(group);
          }
          parts.push(part);
          rest = left;
        }
        return parts;
      };
      module.exports = { SHARE, together };
    }
  });

  // lib/plan/prediction.js
  var require_prediction = __commonJS({
    "lib/plan/prediction.js"(exports, module) {
      "use strict";
      var { cycleCost } = require_model2();
      var { together } = require_together();
      var MOST_TICKS = 1e3;
      var MOST_INTERVALS = 50;
      var families = (intervals) => {
        const all = [];
        for (const interval of intervals) {
          const own = all.find(([first]) => interval % first === 0);
          if (own && intervals.length <= MOST_INTERVALS) own.push(interval);
          else all.push([interval]);
        }
        return all;
      };
      var commonMultiple = (a, b) => {
        let [x, y] = [a, b];
        while (y > 0) [x, y] = [y, x % y];
        return a / x * b;
      };
      var moments = (family) => {
        const [first] = family;
        const ticks = Math.min(MOST_TICKS, family.map((each) => Math.round(each / first)).reduce(commonMultiple, 1));
        const sets = /* @__PURE__ */ new Map();
        for (let tick = 0; tick < ticks; tick++) {
          const due = family.filter((interval) => tick % Math.round(interval / first) === 0);
          const key = due.join();
          const set = sets.get(key) ?? { intervals: due, times: 0 };
          set.times++;
          sets.set(key, set);
        }
        return [...sets.values()].map(({ intervals, times }) => ({ intervals, every: first * ticks / times }));
      };
      var sum = (list, of) => list.reduce((total, each) => total + of(each), 0);
      var timesOf = (requests, { character, gap, silences }, again) => {
        if (requests.length === 0) return { ms: 0, busy: 0 };
        const isRepeated = again && requests.some((request) => request.again < request.cost);
        const bytes = isRepeated ? cycleCost(
          /** @type {any} */
          requests
        ) : sum(requests, ({ cost }) => cost);
        const ms = bytes * character;
        const frames = requests.length * silences - (isRepeated ? silences - 1 : 0);
        return { ms, busy: Math.max(0, ms - frames * gap) };
      };
      var loadOf = (groups, { requestsOf, ...wire }) => {
        const byInterval = new Map(groups.map((group) => [group.interval, group]));
        const plan = (parts) => requestsOf(parts.length === 1 ? parts[0].points : parts.flatMap(({ points }) => points));
        const msOf = (parts) => timesOf(plan(parts), wire, false).ms;
        const due = families([...byInterval.keys()].sort((a, b) => a - b)).flatMap(moments);
        const asked = due.flatMap(
          ({ intervals, every }) => together(
            intervals.map((interval) => byInterval.get(interval)),
            msOf
          ).map((parts) => ({ parts, every }))
        );
        const cycles = asked.map(({ parts, every }) => {
          const requests = plan(parts);
          const intervals = parts.map(({ interval }) => interval);
          return { intervals, every, requests: requests.length, ...timesOf(requests, wire, asked.length === 1) };
        });
        const percent = (of) => 100 * sum(cycles, (cycle) => of(cycle) / cycle.every);
        return { percent: percent(({ ms }) => ms), busyPercent: percent(({ busy }) => busy), cycles };
      };
      module.exports = { loadOf };
    }
  });

  // lib/plan/blocks.js
  var require_blocks = __commonJS({
    "lib/plan/blocks.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var inOrder = (points, kind) => {
        const size = points.length;
        const keys = new Float64Array(size);
        let count = 0;
        for (let at = 0; at < size; at++) if (points[at].kind === kind) keys[count++] = points[at].address * size + at;
        return keys.subarray(0, count).sort();
      };
      var placeAmong = (groups, start, end) => {
        let at = groups.length;
        while (at > 0 && groups[at - 1].start === start && groups[at - 1].end > end) at--;
        const known = groups[at - 1];
        return known && known.start === start && known.end === end ? at - 1 : at;
      };
      var add = (groups, group) => {
        const { start, end, points } = group;
        const at = placeAmong(groups, start, end);
        if (at === groups.length) groups.push(group);
        else if (groups[at].start === start && groups[at].end === end) groups[at].points.push(...points);
        else groups.splice(at, 0, group);
      };
      var groupsOf = (points, kind, pointAt = (at) => at) => {
        const groups = [];
        const keys = inOrder(points, kind);
        for (let n = 0; n < keys.length; n++) {
          const at = keys[n] % points.length;
          const { address, count = 1 } = points[at];
          add(groups, { kind, start: address, end: address + count, points: [pointAt(at)] });
        }
        return groups;
      };
      var borders = (bounds) => {
        const sorted = [...new Set(bounds)].sort((a, b) => a - b);
        return (start) => {
          let low = 0;
          let high = sorted.length;
          while (low < high) {
            const middle = low + high >> 1;
            if (sorted[middle] > start) high = middle;
            else low = middle + 1;
          }
          return low < sorted.length ? sorted[low] : Infinity;
        };
      };
      var blocksOf = (groups, { most, bounds }) => {
        const borderAfter = borders(bounds);
        const blocks = [];
        let block = null;
        let border = Infinity;
        for (const group of groups) {
          const { kind, start, end } = group;
          if (end - start > most)
            throw new PlcError("FRAME_TOO_LONG", { what: `one value of ${kind}s`, got: end - start, most });
          if (block && start <= block.end && end <= Math.max(border, block.end) && end - block.start <= most) {
            block.end = Math.max(block.end, end);
            block.groups.push(group);
          } else {
            block = { kind, start, end, groups: [group] };
            border = borderAfter(start);
            blocks.push(block);
          }
        }
        return blocks;
      };
      var partsOf = ({ kind, groups }) => {
        const parts = [];
        for (const group of groups) {
          const last = parts.at(-1);
          if (last && group.start < last.end) {
            last.end = Math.max(last.end, group.end);
            last.groups.push(group);
          } else parts.push({ kind, start: group.start, end: group.end, groups: [group] });
        }
        return parts;
      };
      module.exports = { blocksOf, groupsOf, partsOf };
    }
  });

  // lib/plan/exact.js
  var require_exact = __commonJS({
    "lib/plan/exact.js"(exports, module) {
      "use strict";
      var MOST_EXACT = 9;
      var SHARES = [0, 0.5, 1];
      var cheapest = (frames, share) => {
        let best = { cost: Infinity, frame: null };
        for (const frame of frames) {
          const cost = frame.cost - share * (frame.cost - frame.again);
          if (cost < best.cost) best = { cost, frame };
        }
        return best;
      };
      var framesOfSubsets = (groups, model) => {
        const all = [null];
        for (let mask = 1; mask < 1 << groups.length; mask++) {
          const frames = model.frames(groups.filter((_, at) => mask & 1 << at));
          all.push(SHARES.map((share) => cheapest(frames, share)));
        }
        return all;
      };
      var tabulate = (subsets, ends) => {
        const table = Array.from({ length: ends + 1 }, () => subsets.map(() => ({ cost: Infinity, part: 0, ends: 0 })));
        table[0][0].cost = 0;
        for (let mask = 1; mask < subsets.length; mask++) {
          const low = mask & -mask;
          for (let part = mask; part > 0; part = part - 1 & mask) {
            if (!(part & low)) continue;
            for (let used = 0; used <= ends; used++) {
              for (let own = 0; own <= Math.min(1, used); own++) {
                const cost = table[used - own][mask ^ part].cost + subsets[part][own].cost;
                if (cost < table[used][mask].cost) table[used][mask] = { cost, part, ends: own };
              }
            }
          }
        }
        return table;
      };
      var collect = (table, subsets, { mask, used }) => {
        const frames = [];
        while (mask > 0) {
          const { part, ends } = table[used][mask];
          frames.push(subsets[part][ends].frame);
          mask ^= part;
          used -= ends;
        }
        return frames;
      };
      var exactPlan = (groups, model) => {
        if (groups.length === 0) return [];
        const subsets = framesOfSubsets(groups, model);
        const mask = subsets.length - 1;
        const used = model.repeats ? 2 : 0;
        const table = tabulate(subsets, used);
        const alone = subsets[mask][2];
        if (model.repeats && alone.frame && alone.cost <= table[used][mask].cost) return [alone.frame];
        return collect(table, subsets, { mask, used });
      };
      module.exports = { MOST_EXACT, exactPlan };
    }
  });

  // lib/plan/merge.js
  var require_merge = __commonJS({
    "lib/plan/merge.js"(exports, module) {
      "use strict";
      var { cycleCost } = require_model2();
      var MOST_FRAMES = 40;
      var joined = (one, other, model) => model.frames([...one.groups, ...other.groups]).filter(({ cost }) => cost < one.cost + other.cost);
      var better = (frames, model) => {
        let least = cycleCost(frames);
        let best = null;
        for (let one = 0; one < frames.length; one++) {
          for (let other = one + 1; other < frames.length; other++) {
            for (const frame of joined(frames[one], frames[other], model)) {
              const plan = [...frames.filter((_, at) => at !== one && at !== other), frame];
              const cost = cycleCost(plan);
              if (cost >= least) continue;
              least = cost;
              best = plan;
            }
          }
        }
        return best;
      };
      var merged = (frames, model) => {
        if (frames.length > MOST_FRAMES) return frames;
        const next = better(frames, model);
        return next ? merged(next, model) : frames;
      };
      module.exports = { merged };
    }
  });

  // lib/plan/chunks.js
  var require_chunks = __commonJS({
    "lib/plan/chunks.js"(exports, module) {
      "use strict";
      var { wordsOf } = require_mixed2();
      var placesOf = (groups, model) => {
        const places = { word: [], bit: [] };
        let among = 0;
        for (const group of groups) {
          const span = group.kind === "word" ? null : wordsOf(group);
          if (!span || !model.isJoint(span)) places[group.kind].push(group);
          else among = places.word.push({ start: span.start, end: span.end, group });
        }
        if (among > 0) places.word.sort((a, b) => a.start - b.start || a.end - b.end);
        return places;
      };
      var bitsOf = (groups) => {
        let first = Infinity;
        let last = -Infinity;
        for (const { kind, start, end } of groups) {
          if (kind === "word") return null;
          first = Math.min(first, start);
          last = Math.max(last, end);
        }
        return { first, last };
      };
      var WORK = 5e5;
      var grainOf = (places, most) => {
        const span = places[places.length - 1].end - places[0].start;
        const reach = Math.min(places.length, most * places.length / span);
        return Math.min(most, Math.ceil(Math.sqrt(places.length * reach / WORK)));
      };
      var chunksIn = (space, places, model) => {
        if (places.length === 0) return [];
        const longest = model.most[space];
        const grain = grainOf(places, longest);
        const chunks = [];
        let last = null;
        const mostAt = (start) => {
          if (start < last.end) return longest;
          return model.borderAfter(space, start - 1) === start ? 0 : grain;
        };
        for (const place of places) {
          const { start, end } = place;
          const group = "group" in place ? place.group : place;
          if (last && start <= last.end && Math.max(end, last.end) - last.start <= mostAt(start)) {
            last.end = Math.max(last.end, end);
            last.groups.push(group);
          } else chunks.push(last = { space, start, end, groups: [group], bits: null, share: null });
        }
        for (const chunk of chunks) {
          chunk.bits = bitsOf(chunk.groups);
          chunk.share = model.mixedShare(chunk);
        }
        return chunks;
      };
      var chunksOf = (groups, model) => {
        const { word, bit } = placesOf(groups, model);
        return [...chunksIn("word", word, model), ...chunksIn("bit", bit, model)];
      };
      module.exports = { chunksOf };
    }
  });

  // lib/plan/pack.js
  var require_pack = __commonJS({
    "lib/plan/pack.js"(exports, module) {
      "use strict";
      var roomOf = (chunks, { shares }) => {
        let room = 0;
        for (const at of chunks) room += shares[at];
        return room;
      };
      var pack = (mixed, { shares, answers }, most) => {
        const plain = mixed.every((at) => shares[at] === 1);
        const bins = [];
        let open = 0;
        for (const at of plain ? mixed : [...mixed].sort((a, b) => shares[b] - shares[a])) {
          let index = open;
          while (index < bins.length && bins[index].used + shares[at] > most) index++;
          if (index === bins.length) bins.push({ used: 0, answer: 0, chunks: [] });
          const bin = bins[index];
          bin.used += shares[at];
          bin.answer += answers[at];
          bin.chunks.push(at);
          while (open < bins.length && bins[open].used === most) open++;
        }
        return bins;
      };
      module.exports = { pack, roomOf };
    }
  });

  // lib/plan/table.js
  var require_table = __commonJS({
    "lib/plan/table.js"(exports, module) {
      "use strict";
      var NO_BIT = -1e9;
      var columnsOf = (chunks, model) => {
        const column = () => new Int32Array(chunks.length);
        const columns = {
          start: column(),
          end: column(),
          /** first bit and the one after the last, where none of the values is a word */
          firstBit: column().fill(NO_BIT),
          lastBit: column(),
          /** addresses and bytes of the answer in a mixed request; 0: it cannot hold them */
          shares: column(),
          answers: column(),
          /** 1: a block may go on from the chunk before it */
          follows: column()
        };
        let last = chunks[0];
        for (let at = 0; at < chunks.length; at++) {
          const chunk = chunks[at];
          columns.start[at] = chunk.start;
          columns.end[at] = chunk.end;
          if (chunk.bits) {
            columns.firstBit[at] = chunk.bits.first;
            columns.lastBit[at] = chunk.bits.last;
          }
          if (chunk.share) {
            columns.shares[at] = chunk.share.count;
            columns.answers[at] = chunk.share.answer;
          }
          if (last.space === chunk.space && model.mayBridge(chunk.space, last.end, chunk.start)) columns.follows[at] = 1;
          last = chunk;
        }
        return columns;
      };
      var reaches = (chunks, { start, end, follows }, model) => {
        const reach = new Int32Array(chunks.length);
        let at = 0;
        for (let first = 0; first < chunks.length; first++) {
          const { space } = chunks[first];
          const most = model.most[space];
          const border = model.borderAfter(space, start[first]);
          if (at <= first) at = end[first] - start[first] > most ? first : first + 1;
          while (at > first && at < chunks.length && follows[at] === 1) {
            if (end[at] > Math.max(border, end[at - 1]) || end[at] - start[first] > most) break;
            at++;
          }
          reach[first] = at;
        }
        return reach;
      };
      var costsByLength = (model, kind) => {
        const costs = new Float64Array(model.most[kind] + 1);
        for (let count = 0; count < costs.length; count++) costs[count] = model.blockCost(kind, count);
        return costs;
      };
      var isWord = ({ space }) => space === "word";
      var chunkTable = (chunks, model) => {
        const columns = columnsOf(chunks, model);
        const reach = reaches(chunks, columns, model);
        return {
          ...columns,
          count: chunks.length,
          /** so many of them stand among words */
          words: chunks.filter(isWord).length,
          /** the chunk after the last that a block can hold which begins there */
          reach,
          /** all blocks that there can be */
          blocks: reach.reduce((sum, end, at) => sum + end - at, 0),
          word: costsByLength(model, "word"),
          bit: costsByLength(model, "bit")
        };
      };
      var costOf = ({ words, start, end, firstBit, lastBit, word, bit }, from, to) => {
        const own = from < words ? word : bit;
        const cost = own[end[to - 1] - start[from]];
        for (let at = from; at < to; at++) if (firstBit[at] === NO_BIT) return cost;
        return Math.min(cost, bit[lastBit[to - 1] - firstBit[from]] ?? Infinity);
      };
      module.exports = { NO_BIT, chunkTable, costOf };
    }
  });

  // lib/plan/priced.js
  var require_priced = __commonJS({
    "lib/plan/priced.js"(exports, module) {
      "use strict";
      var { chunksOf } = require_chunks();
      var { cycleCost } = require_model2();
      var { pack, roomOf } = require_pack();
      var { NO_BIT, chunkTable, costOf } = require_table();
      var PRICES = [-2, -1.5, -1, -0.5, 0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1, 1.5, 2, 3, 5, 8, 12, Infinity];
      var STEPS = 8;
      var WORK = 2e6;
      var MIXED = -1;
      var choose = (table, price, { best, from }) => {
        const { count, words, shares, answers, start, end, reach, firstBit } = table;
        best.fill(Infinity);
        best[0] = 0;
        for (let at = 0; at < count; at++) {
          const here = best[at];
          const mixed = shares[at] > 0 ? here + answers[at] + shares[at] * (2 + price) : Infinity;
          if (mixed < best[at + 1]) {
            best[at + 1] = mixed;
            from[at + 1] = MIXED;
          }
          const own = at < words ? table.word : table.bit;
          const first = start[at];
          const last = reach[at];
          for (let to = at + 1; to <= last; to++) {
            const cost = here + own[end[to - 1] - first];
            if (cost <= best[to]) {
              best[to] = cost;
              from[to] = at;
            }
          }
          if (at < words && firstBit[at] !== NO_BIT) chooseBits(table, at, { best, from });
        }
        return from;
      };
      var chooseBits = ({ reach, firstBit, lastBit, bit }, at, { best, from }) => {
        const here = best[at];
        const first = firstBit[at];
        const last = reach[at];
        for (let to = at + 1; to <= last && firstBit[to - 1] !== NO_BIT; to++) {
          const span = lastBit[to - 1] - first;
          if (span >= bit.length) return;
          const cost = here + bit[span];
          if (cost <= best[to]) {
            best[to] = cost;
            from[to] = at;
          }
        }
      };
      var trace = (table, from) => {
        const mixed = [];
        const blocks = [];
        for (let to = table.count; to > 0; ) {
          const start = from[to] === MIXED ? to - 1 : from[to];
          if (from[to] === MIXED) mixed.push(start);
          else blocks.push({ from: start, to, cost: costOf(table, start, to) });
          to = start;
        }
        return { mixed, blocks };
      };
      var gainOf = (block, { shares, answers }) => {
        let count = 0;
        let gain = block.cost;
        for (let at = block.from; at < block.to && gain > 0; at++) {
          count += shares[at];
          gain = shares[at] === 0 ? 0 : gain - answers[at] - 2 * shares[at];
        }
        return { block, count, gain };
      };
      var range = (from, to) => Array.from({ length: to - from }, (_, at) => from + at);
      var fill = ({ mixed, blocks }, table, most) => {
        const bins = pack(mixed, table, most);
        let room = bins.length * most - roomOf(mixed, table);
        if (room === 0) return { mixed, blocks, bins };
        const gaining = blocks.map((block) => gainOf(block, table)).filter(({ gain, count }) => gain > 0 && count <= room);
        const moved = /* @__PURE__ */ new Set();
        for (const { block, count } of gaining.sort((a, b) => b.gain / b.count - a.gain / a.count)) {
          if (count > room) continue;
          room -= count;
          moved.add(block);
        }
        if (moved.size === 0) return { mixed, blocks, bins };
        const all = [...mixed, ...[...moved].flatMap(({ from, to }) => range(from, to))];
        return { mixed: all, blocks: blocks.filter((block) => !moved.has(block)), bins: pack(all, table, most) };
      };
      var pricesOf = ({ blocks, bins }, { frameCost, repeatCost, queryOfBlock }) => {
        const prices = blocks.map(({ cost }) => ({
          cost,
          again: Math.min(cost, cost - frameCost - queryOfBlock + repeatCost)
        }));
        for (const { used, answer } of bins) {
          const cost = frameCost + 2 * used + answer;
          prices.push({ cost, again: Math.min(cost, repeatCost + answer) });
        }
        return prices;
      };
      var createSearch = (table, model) => {
        const best = { blocks: [], bins: [], cost: Infinity, room: 0 };
        const notes = { best: new Float64Array(table.count + 1), from: new Int32Array(table.count + 1) };
        return {
          best,
          /** @returns {number} addresses that go into mixed requests at this price */
          attempt: (price) => {
            const from = choose(table, price, notes);
            if (notes.best[table.count] === Infinity) return 0;
            const chosen = trace(table, from);
            const room = roomOf(chosen.mixed, table);
            const { blocks, bins } = fill(chosen, table, model.mostMixed);
            const cost = cycleCost(pricesOf({ blocks, bins }, model));
            if (cost < best.cost) Object.assign(best, { blocks, bins, cost, room });
            return room;
          }
        };
      };
      var bisect = (search, target) => {
        let low = PRICES[0];
        let high = 16;
        for (let step = 0; step < STEPS; step++) {
          const price = (low + high) / 2;
          if (search.attempt(price) > target) low = price;
          else high = price;
        }
      };
      var explore = (search, { steps, mostMixed }) => {
        if (mostMixed < 2) return search.attempt(Infinity);
        const tries = Math.max(4, Math.min(PRICES.length, Math.floor(WORK / steps)));
        const stride = (PRICES.length - 1) / (tries - 1);
        for (let at = 0; at < tries; at++) search.attempt(PRICES[Math.round(at * stride)]);
        const full = Math.round(search.best.room / mostMixed);
        const around = [full, full - 1, full + 1].slice(0, Math.max(0, Math.floor((WORK / steps - tries) / STEPS)));
        for (const requests of around) if (requests > 0) bisect(search, requests * mostMixed);
      };
      var cheapest = (frames, key) => frames.reduce((best, frame) => frame[key] < best[key] ? frame : best);
      var groupsIn = (chunks) => {
        const all = [];
        for (const { groups } of chunks) for (const group of groups) all.push(group);
        return all;
      };
      var formsOf = (sets, model) => sets.flatMap((chunks) => {
        const forms = model.frames(groupsIn(chunks));
        return forms.length > 0 ? [forms] : chunks.map(({ groups }) => model.frames(groups));
      });
      var pricedPlan = (groups, model) => {
        const chunks = chunksOf(groups, model);
        const table = chunkTable(chunks, model);
        const search = createSearch(table, model);
        explore(search, { steps: table.blocks + table.count, mostMixed: model.mostMixed });
        const { blocks, bins } = search.best;
        const sets = [
          ...blocks.map(({ from, to }) => chunks.slice(from, to)),
          ...bins.map((bin) => bin.chunks.map((at) => chunks[at]))
        ];
        const forms = formsOf(sets, model);
        const plans = (model.repeats ? ["cost", "again"] : ["cost"]).map((key) => forms.map((each) => cheapest(each, key)));
        return plans.reduce((best, plan) => cycleCost(plan) < cycleCost(best) ? plan : best);
      };
      module.exports = { pricedPlan };
    }
  });

  // lib/plan/reads.js
  var require_reads = __commonJS({
    "lib/plan/reads.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { blocksOf, groupsOf } = require_blocks();
      var { MOST_EXACT, exactPlan } = require_exact();
      var { merged } = require_merge();
      var { LAST_MIXED } = require_mixed2();
      var { Model, cycleCost } = require_model2();
      var { pricedPlan } = require_priced();
      var MOST_GROUPS_MERGED = 300;
      var servedBy = ({ groups, through }, placeOf) => {
        const served = [];
        for (const group of groups) {
          const { kind, start, end, points } = group;
          const count = end - start;
          const isThrough = through(group);
          const at = isThrough ? placeOf("word", start >> 4) : placeOf(kind, start);
          for (const point of points) served.push(isThrough ? { point, at, bit: start & 15, count } : { point, at, count });
        }
        return served;
      };
      var shapeOf = ({ form, span, addresses }) => {
        if (form === "mixed") return { ask: "readMixed", addresses };
        const { kind, start, end } = span;
        return { ask: kind === "bit" ? "readBits" : "readWords", base: start, count: end - start };
      };
      var placesOf = ({ form, span, addresses }) => {
        if (form === "block") return (_kind, address) => address - span.start;
        const places = { bit: /* @__PURE__ */ new Map(), word: /* @__PURE__ */ new Map() };
        addresses.forEach(({ kind, address }, at) => places[kind].set(address, at));
        return (kind, address) => places[kind].get(address);
      };
      var requestOf = (frame) => {
        const { cost, again } = frame;
        return (
          /** @type {any} */
          { ...shapeOf(frame), points: servedBy(frame, placesOf(frame)), cost, again }
        );
      };
      var checkGroups = (groups, model) => {
        for (const group of groups) {
          const { kind, start, end } = group;
          if (end - start === 1 || model.frames([group]).length > 0) continue;
          throw new PlcError("FRAME_TOO_LONG", { what: `one value of ${kind}s`, got: end - start, most: model.most[kind] });
        }
      };
      var plainBlocks = (groups, model, bounds = []) => (
        /** @type {const} */
        ["word", "bit"].flatMap((kind) => {
          const own = groups.filter((group) => group.kind === kind);
          const most = model.most[kind];
          if (own.some(({ start, end }) => end - start > most)) return [];
          return blocksOf(own, { most, bounds: kind === "bit" ? bounds.map((bound) => bound * 16) : bounds });
        })
      );
      var servesAll = (parts, groups) => parts.reduce((sum, part) => sum + part.groups.length, 0) === groups.length;
      var RANK = { word: 0, bit: 1, mixed: 2 };
      var rankOf = ({ form, span }) => RANK[form === "mixed" ? form : span.kind];
      var startOf = ({ form, span, addresses }) => form === "mixed" ? addresses[0].address : span.start;
      var byAddress = (frames) => [...frames].sort((a, b) => rankOf(a) - rankOf(b) || startOf(a) - startOf(b));
      var ordered = (frames) => {
        const [first, last, ...others] = [...frames].sort((a, b) => b.cost - b.again - (a.cost - a.again));
        return last ? [first, ...others, last] : frames;
      };
      var runsOf = (groups) => {
        let runs = 0;
        let last = groups[0].kind;
        let until = -Infinity;
        for (const { kind, start, end } of groups) {
          if (kind !== last || start > until) {
            runs++;
            last = kind;
            until = end;
          } else if (end > until) until = end;
        }
        return runs;
      };
      var bestPlan = (groups, model, limits) => {
        if (groups.length <= MOST_EXACT) return exactPlan(groups, model);
        const priced = pricedPlan(groups, model);
        const found = groups.length <= MOST_GROUPS_MERGED ? merged(priced, model) : priced;
        if ((runsOf(groups) - 1) * model.frameCost >= cycleCost(found)) return found;
        const plain = plainBlocks(groups, model, limits.bounds);
        const isPlain = servesAll(plain, groups) && cycleCost(plain.map((block) => model.pricesOfBlock(block))) <= cycleCost(found);
        return isPlain ? plain.map((block) => model.frames(block.groups)[0]) : found;
      };
      var planReads = (points, limits) => {
        const groups = [...groupsOf(points, "word"), ...groupsOf(points, "bit")];
        if (groups.length === 0) return [];
        const model = new Model(limits);
        checkGroups(groups, model);
        const frames = bestPlan(groups, model, limits);
        return (model.repeats ? ordered(frames) : byAddress(frames)).map(requestOf);
      };
      var servedValues = (answer, { at, count, bit }) => {
        if (bit === void 0) return count === 1 ? [answer[at]] : answer.slice(at, at + count);
        return Array.from({ length: count }, (_, step) => {
          const place = bit + step;
          return Boolean(Number(answer[at + (place >> 4)]) >> (place & 15) & 1);
        });
      };
      module.exports = { LAST_MIXED, planReads, servedValues };
    }
  });

  // lib/plan/share.js
  var require_share = __commonJS({
    "lib/plan/share.js"(exports, module) {
      "use strict";
      var itemsOf = (block) => block.end - block.start;
      var fits = (block, mixed) => block.end - 1 <= mixed.last[block.kind];
      var bestCount = (candidates, { mixed, frameCost, ownCost, sharedCost }) => {
        let own = candidates.reduce((sum, block) => sum + frameCost + ownCost(block), 0);
        let items = 0;
        let bytes = 0;
        let shared = 0;
        let best = { count: 0, cost: own };
        candidates.forEach((block, index) => {
          own -= frameCost + ownCost(block);
          items += itemsOf(block);
          bytes += mixed.size(block);
          shared += sharedCost(block);
          const frames = Math.max(Math.ceil(items / mixed.items), Math.ceil(bytes / mixed.bytes));
          const cost = own + shared + frames * frameCost;
          if (cost < best.cost) best = { count: index + 1, cost };
        });
        return best.count;
      };
      var pack = (parts, mixed) => {
        const frames = [];
        let firstOpen = 0;
        for (const part of [...parts].sort((a, b) => itemsOf(b) - itemsOf(a) || a.start - b.start)) {
          const items = itemsOf(part);
          const bytes = mixed.size(part);
          let frame = null;
          for (let at = firstOpen; at < frames.length && !frame; at++) {
            const { items: used, bytes: full } = frames[at];
            if (used + items <= mixed.items && full + bytes <= mixed.bytes) frame = frames[at];
          }
          if (!frame) frames.push(frame = { items: 0, bytes: 0, parts: [] });
          frame.items += items;
          frame.bytes += bytes;
          frame.parts.push(part);
          while (firstOpen < frames.length && frames[firstOpen].items === mixed.items) firstOpen++;
        }
        return frames.map((frame) => frame.parts.sort((a, b) => a.kind.localeCompare(b.kind) || a.start - b.start));
      };
      var share = (blocks, { mixed, frameCost, ownCost, sharedCost, partsOf }) => {
        const small = (block) => fits(block, mixed) && partsOf(block).every((part) => partFits(part, mixed));
        const candidates = blocks.filter(small).sort((a, b) => mixed.size(a) - mixed.size(b) || a.start - b.start);
        const count = bestCount(candidates, { mixed, frameCost, ownCost, sharedCost });
        const chosen = new Set(candidates.slice(0, count));
        const frames = pack([...chosen].flatMap(partsOf), mixed);
        const alone = frames.filter((parts) => parts.length === 1).flat();
        return {
          own: [...blocks.filter((block) => !chosen.has(block)), ...alone],
          shared: frames.filter((parts) => parts.length > 1)
        };
      };
      var partFits = (part, mixed) => itemsOf(part) <= mixed.items && mixed.size(part) <= mixed.bytes;
      module.exports = { share };
    }
  });

  // lib/plan/writes.js
  var require_writes = __commonJS({
    "lib/plan/writes.js"(exports, module) {
      "use strict";
      var { blocksOf, groupsOf, partsOf } = require_blocks();
      var { LAST_MIXED } = require_reads();
      var { share } = require_share();
      var MANY = 1e6;
      var roundsOf = (points) => {
        const rounds = [];
        const lastOfBit = /* @__PURE__ */ new Map();
        const lastOfWord = /* @__PURE__ */ new Map();
        points.forEach((point, index) => {
          let round = 0;
          const places = point.values.map((_, at) => point.address + at);
          for (const place of places) round = Math.max(round, lastTouch(point.kind, place, { lastOfBit, lastOfWord }) + 1);
          for (const place of places) touch(point.kind, place, { lastOfBit, lastOfWord, round });
          (rounds[round] ?? (rounds[round] = [])).push({ ...point, point: index });
        });
        return rounds;
      };
      var lastTouch = (kind, place, { lastOfBit, lastOfWord }) => {
        if (kind === "bit") return Math.max(lastOfBit.get(place) ?? -1, lastOfWord.get(place >> 4) ?? -1);
        const bits = Array.from({ length: 16 }, (_, bit) => lastOfBit.get(place * 16 + bit) ?? -1);
        return Math.max(lastOfWord.get(place) ?? -1, ...bits);
      };
      var touch = (kind, place, { lastOfBit, lastOfWord, round }) => {
        ;
        (kind === "bit" ? lastOfBit : lastOfWord).set(place, round);
      };
      var blocksFor = (points, kind, limits) => {
        const { writeBits, writeWords, info, bounds = [] } = limits;
        const most = kind === "bit" ? Math.min(writeBits, info - 2) : Math.min(writeWords, info - 2 >> 1);
        const places = points.map(({ kind: own, address, values }) => ({ kind: own, address, count: values.length }));
        const groups = groupsOf(places, kind, (at) => points[at].point);
        return blocksOf(groups, { most, bounds: kind === "bit" ? bounds.map((bound) => bound * 16) : bounds });
      };
      var items = ({ start, end }) => end - start;
      var pointsOf = (parts) => parts.flatMap((part) => part.groups.flatMap((group) => group.points)).sort((a, b) => a - b);
      var ownRequest = (block, valueAt) => {
        const values = Array.from({ length: items(block) }, (_, at) => valueAt(block.kind, block.start + at));
        const ask = block.kind === "bit" ? "writeBits" : "writeWords";
        return (
          /** @type {WriteRequest} */
          { ask, base: block.start, values, points: pointsOf([block]) }
        );
      };
      var sharedRequest = (parts, valueAt) => ({
        ask: "writeMixed",
        writes: parts.flatMap(
          ({ kind, start, end }) => Array.from({ length: end - start }, (_, at) => ({ kind, address: start + at, value: valueAt(kind, start + at) }))
        ),
        points: pointsOf(parts)
      });
      var planRound = (points, limits) => {
        const values = /* @__PURE__ */ new Map();
        for (const { kind, address, values: given } of points) {
          given.forEach((value, at) => values.set(`${kind}${address + at}`, value));
        }
        const valueAt = (kind, address) => values.get(`${kind}${address}`);
        const { own, shared } = share([...blocksFor(points, "word", limits), ...blocksFor(points, "bit", limits)], {
          mixed: {
            items: limits.writeMixed,
            bytes: limits.info,
            last: { bit: LAST_MIXED, word: LAST_MIXED },
            size: (block) => items(block) * (block.kind === "bit" ? 3 : 4)
          },
          frameCost: MANY,
          ownCost: (block) => 2 + items(block) * (block.kind === "bit" ? 1 : 2),
          sharedCost: (block) => items(block) * (block.kind === "bit" ? 3 : 4),
          partsOf
        });
        return [...own.map((block) => ownRequest(block, valueAt)), ...shared.map((parts) => sharedRequest(parts, valueAt))];
      };
      var planRounds = (rounds, limits) => rounds.flatMap((round) => planRound(round, limits));
      var planWrites = (points, limits) => planRounds(roundsOf(points), limits);
      module.exports = { planRounds, planWrites, roundsOf };
    }
  });

  // lib/plan/tables.js
  var require_tables = __commonJS({
    "lib/plan/tables.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { planReads } = require_reads();
      var { planRounds, roundsOf } = require_writes();
      var WIDE = 1048576;
      var limitsOf = ({ read, write, unit, frameCost, scale }) => ({
        ...{ unit, frameCost, scale, bitBytes: 1 / 8 },
        readBits: read,
        readWords: read,
        readMixed: 0,
        writeBits: write,
        writeWords: write,
        writeMixed: 0,
        info: WIDE
      });
      var holesIn = ({ kind, from, to }, holes = []) => holes.filter((hole) => hole.kind === kind && from <= hole.start && hole.start < to);
      var within = ({ kind, from, to }, points) => points.map((point, index) => ({ point, index })).filter(({ point }) => point.kind === kind && from <= point.address && point.address < to);
      var planTables = (points, tables, { holes } = {}) => tables.flatMap((table) => {
        const own = within(table, points);
        const requests = planReads(
          own.map(({ point }) => point),
          { ...limitsOf(table), holes: holesIn(table, holes) }
        );
        return requests.map((request) => ({
          ...request,
          points: request.points.map((each) => ({ ...each, point: own[each.point].index }))
        }));
      });
      var bitsOfWords = (points) => {
        const words = /* @__PURE__ */ new Map();
        for (const { address, values, point } of points) {
          values.forEach((value, at) => {
            const base = address + at >> 4;
            const bit = 1 << (address + at & 15);
            const request = words.get(base) ?? { ask: "writeBitsOfWord", base, mask: 0, value: 0, points: [] };
            request.mask |= bit;
            if (value) request.value |= bit;
            if (!request.points.includes(point)) request.points.push(point);
            words.set(base, request);
          });
        }
        return [...words.values()].sort((a, b) => a.base - b.base);
      };
      var planRound = (points, tables) => {
        const plain = points.filter((point) => !point.through);
        const requests = tables.flatMap((table) => {
          const own = within(table, plain).map(({ point }) => point);
          if (own.length > 0 && table.write === 0) {
            throw new PlcError("FRAME_TOO_LONG", { what: `a write of ${table.kind}s`, got: own.length, most: 0 });
          }
          return planRounds([own], limitsOf(table));
        });
        return [...requests, ...bitsOfWords(points.filter((point) => point.through))];
      };
      var planTableWrites = (points, tables) => roundsOf(points).flatMap((round) => planRound(round, tables));
      module.exports = { planTableWrites, planTables };
    }
  });

  // lib/plan/index.js
  var require_plan = __commonJS({
    "lib/plan/index.js"(exports, module) {
      "use strict";
      var { loadOf } = require_prediction();
      var { planReads, servedValues } = require_reads();
      var { planTableWrites, planTables } = require_tables();
      var { together } = require_together();
      var { planWrites } = require_writes();
      module.exports = { loadOf, planReads, planTableWrites, planTables, planWrites, servedValues, together };
    }
  });

  // lib/device/settings.js
  var require_settings = __commonJS({
    "lib/device/settings.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { masterIdList } = require_ids();
      var { limitsOf } = require_limits();
      var { nxNotation } = require_nx_notation();
      var { describeAddress } = require_address2();
      var { planReads, planWrites } = require_plan();
      var { TURNAROUND, choice, isOn, nameOf, readHealth, readRanges, wholeNumber } = require_options();
      var LAST_STATION = 191;
      var ANY_STATION = 255;
      var GAP = 10;
      var readStation = (value) => {
        const number = typeof value === "string" && /^\s*\d{1,3}\s*$/.test(value) ? Number(value) : value;
        if (typeof number !== "number" || !Number.isInteger(number) || number < 0 || number > 255) {
          throw new PlcError("BAD_STATION", {
            station: value,
            reason: "it must be 0 to 191, or 255 for the only PLC of a line"
          });
        }
        if (number > LAST_STATION && number !== ANY_STATION) {
          throw new PlcError("BAD_STATION", { station: number, reason: "192 to 254 are numbers of masters" });
        }
        return number;
      };
      var markHex = (value) => typeof value === "string" ? value.replace(/(?<![$\w])(?=\d?[a-f])[\da-f]{2}(?!\w)/gi, "0x$&") : value;
      var masterIdsOf = (value, stations = []) => masterIdList(markHex(value), { stations });
      var boundsOf = (areas) => areas.list.flatMap(({ base, words }) => [base, base + words]);
      var jointOf = (areas) => areas.list.filter(({ as }) => as === "both").map(({ base, words }) => [base, base + words]);
      var costsOf = ({ steps, gap, character, turnaround, repeats }) => {
        const wait = (gap + turnaround) / character;
        const frameCost = steps === 4 ? 26 + 2 * wait : 12 + wait;
        return repeats ? { frameCost, again: 13 + wait } : { frameCost };
      };
      var SPLITS = /* @__PURE__ */ new Set(["PLC_OUT_OF_RANGE", "PLC_FRAME_TOO_LONG"]);
      var ABSENT = /* @__PURE__ */ new Set(["PLC_OUT_OF_RANGE"]);
      var UNKNOWN_FUNCTION = /* @__PURE__ */ new Set(["PLC_WRONG_FUNCTION", "PLC_NO_SERVICE"]);
      var planOf = (given, { soleMaster, ...wire }) => {
        let limits = given;
        const costs = ({ turnaround = TURNAROUND, repeats = true }) => costsOf({ ...wire, turnaround, repeats: soleMaster && repeats });
        return {
          gap: wire.gap,
          silences: wire.steps === 4 ? 2 : 1,
          reads: (points, facts = {}) => planReads(points, { ...limits, ...costs(facts), holes: facts.holes }),
          writes: (points) => planWrites(points, limits),
          splits: SPLITS,
          absent: ABSENT,
          simpler: ({ ask }, { code }) => {
            if (ask !== "readMixed" || !UNKNOWN_FUNCTION.has(code)) return false;
            limits = { ...limits, readMixed: 0 };
            return true;
          }
        };
      };
      var REASONS = Object.freeze({
        area: "its area is unconfirmed or not for writing; confirm its row in the area table first",
        throughWord: "its area has only words: a single bit of it cannot be written"
      });
      var readSettings = (given, character, lineGap = 0) => {
        const station = readStation(given.station);
        const steps = (
          /** @type {2|4} */
          choice("steps", given.steps, [2, 4])
        );
        const gap = wholeNumber("gap", given.gap, { fallback: GAP, least: 0, most: 1e4 }) || GAP;
        const wordOrder = choice("wordOrder", given.wordOrder, ["low", "high"]);
        const byteOrder = choice("byteOrder", given.byteOrder, ["low", "high"]);
        const notation = nxNotation({ areas: given.areas || [], tags: given.tags, wordOrder, byteOrder });
        const stations = [...given.stations ?? [], station];
        const limits = limitsOf(given.limits);
        const soleMaster = isOn(given.soleMaster);
        const memory = { bounds: boundsOf(notation.areas), joint: jointOf(notation.areas) };
        return {
          protocol: "nx",
          station,
          steps,
          gap,
          name: nameOf(given.name, station),
          timeout: wholeNumber("timeout", given.timeout, { fallback: 3e3, least: 10, most: 6e5 }),
          attempts: wholeNumber("attempts", given.attempts, { fallback: 3, least: 1, most: 20 }),
          ...readHealth(given),
          masterIds: masterIdsOf(given.masterIds, stations),
          soleMaster,
          access: choice("access", given.access, ["read", "write"]),
          ranges: readRanges(given.writableRanges, notation),
          writeInterval: wholeNumber("writeInterval", given.writeInterval, { fallback: 0, least: 0, most: 36e5 }),
          deadline: wholeNumber("deadline", given.deadline, { fallback: 0, least: 0, most: 36e5 }),
          notation,
          limits,
          reasons: REASONS,
          describe: (place, { write }) => describeAddress(place, { steps, write }),
          plan: planOf({ ...limits, ...memory }, { steps, gap: Math.max(gap, lineGap), character, soleMaster })
        };
      };
      module.exports = { masterIdsOf, readSettings, readStation };
    }
  });

  // scripts/editor/check.js
  var require_check = __commonJS({
    "scripts/editor/check.js"(exports, module) {
      "use strict";
      var { PROPERTIES, readProperty, allowed, applies } = require_properties();
      var { lineOfListener, listenerOf } = require_line_use();
      var { t, errorText } = require_texts();
      var { truthy } = require_widgets();
      var { readRanges } = require_options();
      var { mixedConflict } = require_mixed();
      var { masterIdsOf, readSettings } = require_settings();
      var { readTags } = require_tags();
      var { TYPES, attempt, canOnlyBeRead, deviceName, notationOf, notationWithTags, parseItem } = require_model();
      var edited = { id: null, prefix: "node-input-" };
      var open = (node, prefix) => Object.assign(edited, { id: node.id, prefix });
      var done = () => {
        edited.id = null;
      };
      var current = (node, name) => {
        const field = edited.id === node.id ? $(`#${edited.prefix}${name}`) : $();
        if (field.length === 0) return node[name];
        return field.is(":checkbox") ? field.prop("checked") : field.val();
      };
      var view = (node) => new Proxy({}, { get: (_, name) => current(node, String(name)) });
      var isVariable = (value) => typeof value === "string" && /^\s*\$\{[^}]+\}\s*$/.test(value);
      var neighbours = (node) => {
        const line = current(node, "line");
        const found = [];
        RED.nodes.eachConfig((other) => {
          if (TYPES.includes(other.type) && other.id !== node.id && other.line === line && !other.d) found.push(other);
          return true;
        });
        return found;
      };
      var memberOf = ({ type, station, masterIds }) => ({
        protocol: type === "chino-config" ? "modbus" : "nx",
        station: Number(station),
        masterIds: [...attempt(() => masterIdsOf(masterIds), [])],
        name: ""
      });
      var checkNumber = (type) => (node, station) => {
        const own = memberOf({ type, station, masterIds: current(node, "masterIds") });
        const listener = listenerOf(current(node, "line"));
        if (listener) return t("problem.listened", { other: listener });
        for (const other of neighbours(node)) {
          const name = deviceName(other);
          if (String(other.station) === String(station).trim()) return t("problem.sameStation", { other: name });
          const reason = isVariable(other.station) ? "" : mixedConflict(own, memberOf(other));
          if (reason) return t("problem.mixed", { other: name, reason });
        }
        return true;
      };
      var checkPlcNumber = checkNumber("nx-config");
      var checkRegulatorNumber = checkNumber("chino-config");
      var checkUnit = (count) => (node, value) => Number(value) <= Number(current(node, count)) || t("problem.unit");
      var checkItems = (property, type) => (node, value) => {
        if (current(node, "itemsType") === "msg") return true;
        if (!value || value.length === 0) return t("problem.noItems");
        const notation = notationWithTags(deviceOf(node, property) || { type });
        value.filter((text) => !isVariable(text)).forEach((text) => parseItem(text, notation));
        return true;
      };
      var checkTarget = (property) => (node, value) => {
        if (!String(value || "").trim()) return true;
        const device = deviceOf(node, property);
        if (!device) return true;
        const item = parseItem(value, notationWithTags(device));
        if (device.access !== "write") return t("problem.readOnly", { plc: deviceName(device) });
        return canOnlyBeRead(item, device) ? `${value}: ${t("editor.readable")}` : true;
      };
      var deviceOf = (node, property) => RED.nodes.node(current(node, property));
      var isBroadcast = (node) => {
        const device = deviceOf(node, "regulator");
        return Boolean(device) && String(device.station).trim() === "0";
      };
      var chino = (node) => {
        const { addressMode, wordOrder } = view(node);
        return { type: "chino-config", addressMode, wordOrder };
      };
      var checkEnd = (node, value) => Boolean(`${value}${current(node, "last") ?? ""}`.trim()) || t("problem.needsEnd");
      var checkCount = (_node, value) => Number(value) > 0 || t("problem.needsCount");
      var checkGap = (node, value) => truthy(current(node, "bidirectional")) || current(node, "framing") !== "gap" || Number(value) > 0 || t("problem.needsGap");
      var checkFlow = (node, value) => value !== "dc" || !truthy(current(node, "bidirectional")) || t("problem.noDc");
      var checkAcknowledge = (node, value) => !truthy(value) || truthy(current(node, "checked")) || t("problem.needsChecked");
      var MORE = {
        "nx-config": {
          station: checkPlcNumber,
          masterIds: (_node, value) => Boolean(readSettings({ station: 255, masterIds: value }, 1)),
          writableRanges(node, writableRanges) {
            const { areas } = view(node);
            return Boolean(readSettings({ station: 255, areas: areas || [], writableRanges }, 1));
          },
          areas: (_node, value) => Boolean(notationOf({ areas: value })),
          tags(node, value) {
            readTags(value, notationOf({ areas: node.areas }));
            return true;
          }
        },
        "chino-config": {
          station(node, value) {
            const all = Number(value) === 0 && !truthy(current(node, "broadcast"));
            return all ? t("problem.broadcastOff") : checkRegulatorNumber(node, value);
          },
          protocol(node, value) {
            const line = RED.nodes.node(current(node, "line"));
            return value === "rtu" && line && String(line.dataBits) === "7" ? t("problem.dataBits") : true;
          },
          coilUnit: checkUnit("coilRead"),
          discreteUnit: checkUnit("discreteRead"),
          writableRanges: (node, value) => Boolean(readRanges(value, notationOf(chino(node)))),
          tags(node, value) {
            readTags(value, notationOf(chino(node)));
            return true;
          }
        },
        "nx-read": { items: checkItems("plc", "nx-config") },
        "nx-write": { target: checkTarget("plc") },
        "chino-regulator": {
          mode: (node, value) => value === "write" || !isBroadcast(node) || t("problem.broadcastMode"),
          verify: (node, value) => !truthy(value) || !isBroadcast(node) || t("problem.broadcastMode"),
          items: checkItems("regulator", "chino-config"),
          target: checkTarget("regulator")
        },
        "melsec-c24": {
          line: (node) => lineOfListener(node, (name) => current(node, name)),
          end: checkEnd,
          count: checkCount,
          gap: checkGap,
          flow: checkFlow
        },
        "incon-link": {
          line: (node) => lineOfListener(node, (name) => current(node, name)),
          acknowledge: checkAcknowledge
        }
      };
      var isEmpty = (value) => value === void 0 || value === null || value === "";
      var verdict = (type, { name, node, value }) => {
        const row = PROPERTIES[type][name];
        if (isVariable(value)) return true;
        const { problem } = readProperty(row, value);
        if (problem)
          return t(`problem.${problem}`, { allowed: allowed(row).replace(/^(\d+) to (\d+)/, `$1${t("editor.to")}$2`) });
        const more = MORE[type] && MORE[type][name];
        return more && (row.kind === "list" || row.blank || !isEmpty(value)) ? more(node, value) : true;
      };
      var check = (type, name) => (
        // two declared parameters tell the editor that a reason may come as a text
        function(value, _options) {
          try {
            if (!applies(type, name, view(this))) return true;
            return verdict(type, { name, node: this, value });
          } catch (error) {
            return errorText(error);
          }
        }
      );
      module.exports = { check, current, open, done, isVariable, view };
    }
  });

  // scripts/editor/line.js
  var require_line = __commonJS({
    "scripts/editor/line.js"(exports, module) {
      "use strict";
      var { current, open } = require_check();
      var { fillDefaults, suggest, tabs } = require_widgets();
      var { t } = require_texts();
      var PREFIX = "node-config-input-";
      var SPEEDS = ["1200", "2400", "4800", "9600", "19200", "38400", "57600", "115200"];
      var lineLabel = (line) => {
        if (line.transport === "tcp") return line.host ? `${line.host}:${line.port}` : t("editor.newLine");
        if (line.transport === "simulated") return t("editor.simulatedLine");
        return line.path || t("editor.newLine");
      };
      var loadPorts = () => $.getJSON("plc-line/ports").then(
        (answer) => answer.ports,
        () => []
      );
      var showMenu = (button, ports) => {
        const field = $(`#${PREFIX}path`);
        const options = ports.map((port) => ({
          label: port.label,
          onselect: () => field.val(port.path).trigger("change")
        }));
        if (options.length === 0) options.push({ label: t("editor.noPorts"), disabled: true, onselect: () => {
        } });
        const menu = RED.popover.menu({ options });
        menu.show({ target: button, align: "left", offset: [button.outerWidth() - 2, -1], dispose: true });
      };
      var show = (transport) => {
        $(".nxline-serial").toggle(transport === "serial");
        $(".nxline-tcp").toggle(transport === "tcp");
        $(".nxline-simulated").toggle(transport === "simulated");
        $(".nxline-real").toggle(transport !== "simulated");
      };
      var editLine = (node) => {
        open(node, PREFIX);
        fillDefaults(node, PREFIX);
        tabs("nxline-line-tabs", [
          ["nxline-line-connection", t("tab.connection")],
          ["nxline-line-details", t("tab.details")]
        ]);
        let ports = [];
        const refresh = () => loadPorts().then((found) => {
          ports = found;
          return found;
        });
        suggest(
          $(`#${PREFIX}path`),
          () => ports.map((port) => ({ value: port.path, first: port.label })),
          () => true
        );
        suggest(
          $(`#${PREFIX}baudRate`),
          () => SPEEDS.map((value) => ({ value })),
          () => true
        );
        const button = $("#nxline-line-ports").attr("title", t("editor.listPorts"));
        button.on("click", () => refresh().then((found) => showMenu(button, found)));
        refresh();
        $(`#${PREFIX}transport`).on("change", function() {
          show($(this).val());
          $(`#${PREFIX}path, #${PREFIX}host, #${PREFIX}port`).trigger("change");
        }).trigger("change");
        show(current(node, "transport"));
      };
      module.exports = { editLine, lineLabel };
    }
  });

  // scripts/editor/table.js
  var require_table2 = __commonJS({
    "scripts/editor/table.js"(exports, module) {
      "use strict";
      var { truthy } = require_widgets();
      var rowsOf = (list) => list.editableList("items").toArray().map((row) => row.data("nxline").read());
      var kept = (saved, name, value) => {
        const before = saved[name];
        const same = typeof value === "boolean" ? value === truthy(before) : value === String(before ?? "").trim();
        return same ? before : value;
      };
      var EMPTY = ["", false];
      var merged = (saved, cells) => {
        const row = { ...saved };
        for (const [name, value] of Object.entries(cells)) {
          row[name] = kept(saved, name, value);
          if (row[name] === void 0 || EMPTY.includes(row[name]) && row[name] !== saved[name]) delete row[name];
        }
        return row;
      };
      var readFields = (fields, saved) => {
        const content = (field) => field.box ? field.box.prop("checked") : String(field.val() ?? "").trim();
        const cells = Object.fromEntries(Object.entries(fields).map(([name, field]) => [name, content(field)]));
        return merged(saved, cells);
      };
      module.exports = { merged, readFields, rowsOf };
    }
  });

  // scripts/editor/areas.js
  var require_areas2 = __commonJS({
    "scripts/editor/areas.js"(exports, module) {
      "use strict";
      var { areaMap } = require_areas();
      var { attempt, hex } = require_model();
      var { readFields, rowsOf } = require_table2();
      var { cell, flex, note, pick, say, tick } = require_widgets();
      var { errorText, t } = require_texts();
      var areaFields = (data) => ({
        area: cell("area", data.area, { width: "60px" }),
        base: cell("base", data.base, { width: "80px" }),
        words: cell("words", data.words, { width: "70px" }),
        as: pick("as", data.as || "", [
          ["", t("editor.asBefore")],
          ["both", t("editor.asBoth")],
          ["bits", t("editor.asBits")],
          ["words", t("editor.asWords")]
        ]),
        note: cell("areaNote", data.note, { grow: true, width: "60px" }),
        confirmed: tick("confirmed", data.confirmed),
        remove: tick("remove", data.remove)
      });
      var readArea = (fields, saved) => {
        const row = readFields(fields, saved);
        if (row.area) row.area = String(row.area).toUpperCase();
        return row.remove ? { area: row.area, remove: row.remove } : row;
      };
      var areaFault = (row, rows) => {
        try {
          areaMap(rows);
          return null;
        } catch (error) {
          const { name, reason } = error.details;
          return name === row.area || String(reason).includes(`${row.area} (`) ? error : null;
        }
      };
      var areaText = (row, rows) => {
        const map = attempt(() => areaMap(rows), null) || attempt(() => areaMap([row]), null);
        if (!map) return "";
        const known = map.get(row.area);
        if (!known) return t("editor.areaRemoved");
        const range = `${hex(known.base, 4)}h..${hex(known.base + known.words - 1, 4)}h`;
        return t(known.writable ? "editor.areaWritable" : "editor.areaReadable", { range });
      };
      var judgeArea = (row, { block, rows }) => {
        if (!row.area) return say(block, t("editor.areaHint"));
        const fault = areaFault(row, rows);
        return fault ? say(block, errorText(fault), true) : say(block, areaText(row, rows));
      };
      var addArea = (container, data, judgeAll) => {
        const fields = areaFields(data);
        const block = note();
        const read = () => readArea(fields, data);
        const judge = (rows) => {
          const standard = areaMap().get(read().area);
          fields.base.attr("placeholder", standard ? `0x${hex(standard.base, 4)}` : t("column.base"));
          fields.words.attr("placeholder", standard ? standard.words : t("column.words"));
          judgeArea(read(), { block, rows });
        };
        container.append(
          flex(fields.area, fields.base, fields.words, fields.as, fields.note, fields.confirmed.label, fields.remove.label)
        ).append(block).on("input change", judgeAll);
        container.data("nxline", { read, judge });
      };
      var areaTable = (list, areas, changed) => {
        const judgeAll = () => {
          const rows = rowsOf(list).filter((row) => row.area);
          list.editableList("items").toArray().forEach((row) => row.data("nxline").judge(rows));
          changed();
        };
        list.editableList({
          addItem: (container, _index, data) => {
            addArea(container, data, judgeAll);
            setTimeout(judgeAll, 0);
          },
          removeItem: judgeAll,
          addButton: t("editor.addArea"),
          removable: true,
          height: 220
        });
        (areas || []).forEach((row) => list.editableList("addItem", row));
      };
      module.exports = { areaFault, areaTable };
    }
  });

  // lib/tag/csv.js
  var require_csv = __commonJS({
    "lib/tag/csv.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { FIELDS } = require_tags();
      var SEPARATORS = [",", ";", "	"];
      var separatorOf = (text) => {
        const line = text.replace(/"(?:[^"]|"")*"/g, "").split(/\r\n|\r|\n/, 1)[0];
        const counts = SEPARATORS.map((separator) => line.split(separator).length);
        return SEPARATORS[counts.indexOf(Math.max(...counts))];
      };
      var unquote = (cell) => cell.startsWith('"') ? cell.slice(1, -1).replaceAll('""', '"') : cell;
      var parseCells = (text, separator) => {
        const other = separator === "	" ? "\\t" : separator;
        const cell = new RegExp(`("(?:[^"]|"")*"|[^"${other}\\r\\n][^${other}\\r\\n]*|)(${other}|\\r\\n|\\r|\\n|$)`, "y");
        const rows = [[]];
        let line = 1;
        while (cell.lastIndex < text.length || rows.at(-1)?.length) {
          const from = cell.lastIndex;
          const found = cell.exec(text);
          if (!found)
            throw new PlcError("BAD_TAG", { name: `in line ${line}`, reason: "a quote is not closed, or text follows it" });
          rows[rows.length - 1].push(unquote(found[1]));
          line += (found[0].match(/\r\n|\r|\n/g) || []).length;
          if (found[2] === "") break;
          if (found[2] !== separator) rows.push([]);
          if (cell.lastIndex === from) break;
        }
        return rows.filter((row) => row.some((value) => value.trim() !== ""));
      };
      var tagsFromCsv = (text) => {
        const body = String(text).replace(/^\uFEFF/, "");
        const separator = separatorOf(body);
        const [head = [], ...rows] = parseCells(body, separator);
        const columns = head.map((title) => FIELDS.find((field) => field.toLowerCase() === title.trim().toLowerCase()));
        for (const needed of ["name", "address"]) {
          if (!columns.includes(needed))
            throw new PlcError("BAD_TAG", { name: "table", reason: `the column ${needed} is missing` });
        }
        const decimal = (value) => separator === "," ? value : value.replace(/^(\s*[+-]?\d*),(\d+\s*%?\s*)$/, "$1.$2");
        const numeric = /* @__PURE__ */ new Set(["scale", "offset", "deadband", "min", "max", "maxStep"]);
        return rows.map((cells) => {
          const row = {};
          columns.forEach((field, index) => {
            if (field) row[field] = numeric.has(field) ? decimal(cells[index] ?? "") : cells[index] ?? "";
          });
          return row;
        });
      };
      var csvWarnings = (rows, notation) => rows.flatMap((row) => {
        const { name = "", address = "" } = row ?? {};
        const texts = notation.doubts?.(row ?? {}) ?? [];
        return texts.map((text) => ({ name: String(name), address: String(address), text }));
      });
      var cellOf = (value) => {
        const text = value === null || value === void 0 ? "" : String(value);
        return /[",;\t\r\n]|^\s|\s$/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
      };
      var tagsToCsv = (tags, { separator = "," } = {}) => {
        const lines = [FIELDS, ...Array.from(tags, (tag) => FIELDS.map((field) => tag[field]))];
        return `\uFEFF${lines.map((cells) => cells.map(cellOf).join(separator)).join("\r\n")}\r
`;
      };
      module.exports = { csvWarnings, tagsFromCsv, tagsToCsv };
    }
  });

  // scripts/editor/tags.js
  var require_tags2 = __commonJS({
    "scripts/editor/tags.js"(exports, module) {
      "use strict";
      var { csvWarnings, tagsFromCsv, tagsToCsv } = require_csv();
      var { parseExpression } = require_item();
      var { readTags } = require_tags();
      var { describe, notationOf, unsure } = require_model();
      var { merged, readFields, rowsOf } = require_table2();
      var { cell, flex, mark, note, pick, say, tick } = require_widgets();
      var { reasonOf, t } = require_texts();
      var TYPES = ["", "bool", "uint16", "int16", "uint32", "int32", "float32", "bcd16", "bcd32", "string[8]"];
      var MOST_DOUBTS = 5;
      var tagText = (row, device) => {
        const notation = notationOf(device);
        const tag = [...readTags([row], notation).values()][0];
        const item = parseExpression(tag.address, notation, { tag });
        return describe(item, device) + (unsure(item, notation) ? ` · ${t("editor.unconfirmed")}` : "");
      };
      var judgeTag = (row, block, device) => {
        const modbus = device.type === "chino-config";
        if (!row.name && !row.address) return say(block, t(modbus ? "editor.modbusTagHint" : "editor.tagHint"));
        if (modbus && !row.address) return say(block, t("editor.fillIn"), true);
        try {
          return say(block, tagText(row, device));
        } catch (error) {
          return say(block, reasonOf(error), true);
        }
      };
      var typeField = (value) => {
        const known = TYPES.map((type) => [type, type || t("editor.byAddress")]);
        return pick("type", value, known);
      };
      var orders = (saved, { type }) => {
        const known = [
          ["low", t("editor.lowFirst")],
          ["high", t("editor.highFirst")]
        ];
        if (type === "chino-config") return [["", t("editor.deviceOrder")], ...known];
        return saved === "low" ? known : [["", t("editor.lowFirst")], known[1]];
      };
      var narrow = (field) => field.css({ width: "48px", padding: "4px" });
      var tagFields = (data, device) => {
        const writable = tick("writable", data.writable);
        const hint = t(device.type === "chino-config" ? "editor.modbusAddress" : "tooltip.address");
        return {
          name: cell("tagName", data.name, { width: "24%" }),
          address: cell("address", data.address, { width: "22%", hint }),
          type: typeField(data.type),
          label: cell("tagLabel", data.label, { grow: true, width: "20%" }),
          unit: cell("unit", data.unit, { width: "64px" }),
          scale: narrow(cell("scale", data.scale, { shows: "1" })),
          offset: narrow(cell("offset", data.offset, { shows: "0" })),
          deadband: narrow(cell("deadband", data.deadband, { shows: "0" })),
          wordOrder: pick("wordOrder", data.wordOrder, orders(data.wordOrder, device)).css({
            flex: "0 1 132px",
            minWidth: 0,
            padding: "4px"
          }),
          min: narrow(cell("min", data.min, { shows: "–" })),
          max: narrow(cell("max", data.max, { shows: "–" })),
          maxStep: narrow(cell("maxStep", data.maxStep, { shows: "–" })),
          writable
        };
      };
      var addTag = (container, data, device) => {
        const fields = tagFields(data, device());
        const message = note();
        const read = () => readFields(fields, data);
        const judge = () => judgeTag(read(), message, device());
        container.append(flex(fields.name, fields.address, fields.type, fields.label, fields.unit)).append(
          flex(
            ...[mark("×"), fields.scale, mark("+"), fields.offset, mark(t("column.deadband")), fields.deadband],
            ...[fields.wordOrder, mark(t("column.min")), fields.min, mark(t("column.max")), fields.max],
            ...[mark(t("column.maxStep")), fields.maxStep, fields.writable.label]
          )
        ).append(message).on("input change", judge);
        container.data("nxline", { read, judge });
        judge();
      };
      var tagTable = (list, tags, device) => {
        list.editableList({
          header: $("<div>").css({ padding: "2px 6px", color: "var(--red-ui-secondary-text-color)" }).text(t("editor.tagHeader")),
          addItem: (container, _index, data) => addTag(container, data, device),
          addButton: t("editor.addTag"),
          removable: true,
          sortable: true,
          scrollOnAdd: true,
          height: 300
        });
        (tags || []).forEach((tag) => list.editableList("addItem", tag));
      };
      var TEMPLATE = [
        { name: "manual_output", label: "template.manualOutput", unit: "%" },
        { name: "gradient", label: "template.gradient", unit: "%" },
        { name: "elevation", label: "template.elevation", unit: "%" },
        { name: "load_voltage", label: "template.loadVoltage", unit: "V" },
        { name: "load_current", label: "template.loadCurrent", unit: "A" },
        { name: "load_power", label: "template.loadPower", unit: "W" },
        { name: "load_resistance", label: "template.loadResistance", unit: "Ω" },
        { name: "alarm", label: "template.alarm" }
      ];
      var missingRows = (present) => {
        const names = new Set(present.map(({ name }) => name));
        return TEMPLATE.filter(({ name }) => !names.has(name)).map((row) => ({ ...row, label: t(row.label), address: "" }));
      };
      var addTemplate = (list) => {
        missingRows(rowsOf(list)).forEach((row) => list.editableList("addItem", row));
        const empty = list.find(".nxline-address").filter((_, each) => each.value === "");
        if (empty.length === 0) return;
        empty[0].closest("li").scrollIntoView({ block: "nearest" });
        empty[0].focus();
      };
      var doubtOf = (rows, notation) => {
        const found = csvWarnings(rows, notation).map(({ name, text }) => `${name}: ${text}`);
        if (found.length === 0) return "";
        const first = found.slice(0, MOST_DOUBTS).join(" · ");
        return t("editor.doubt", { list: found.length > MOST_DOUBTS ? `${first} …` : first });
      };
      var importTags = (list, text, device) => {
        const rows = tagsFromCsv(text);
        const notation = notationOf(device);
        readTags(rows, notation);
        const names = new Set(rows.map((row) => row.name.trim()));
        list.editableList("items").toArray().filter((row) => names.has(row.data("nxline").read().name)).forEach((row) => list.editableList("removeItem", row.data("data")));
        rows.forEach((row) => list.editableList("addItem", merged({}, row)));
        return { count: rows.length, doubt: doubtOf(rows, notation) };
      };
      var download = (name, text) => {
        const url = URL.createObjectURL(new Blob([text], { type: "text/csv;charset=utf-8" }));
        const link = $("<a>").attr({ href: url, download: name }).appendTo("body");
        link[0].click();
        link.remove();
        URL.revokeObjectURL(url);
      };
      var exportTags = (list, name) => download(`${name || "tags"}.csv`, tagsToCsv(rowsOf(list)));
      module.exports = { addTemplate, doubtOf, exportTags, importTags, missingRows, tagTable };
    }
  });

  // scripts/editor/device.js
  var require_device = __commonJS({
    "scripts/editor/device.js"(exports, module) {
      "use strict";
      var { check, done, open } = require_check();
      var { exportTags, importTags, tagTable } = require_tags2();
      var { rowsOf } = require_table2();
      var { fillDefaults, tabs } = require_widgets();
      var { capital, causeText, errorText, t } = require_texts();
      var PREFIX = "node-config-input-";
      var field = (name) => $(`#${PREFIX}${name}`);
      var value = (name) => field(name).val();
      var fieldValue = (name) => field(name).is(":checkbox") ? field(name).prop("checked") : value(name);
      var tagRows = (list) => rowsOf(list).filter((row) => row.name || row.address);
      var wireCsv = ({ part, list, device }, node) => {
        part("export").on("click", () => {
          exportTags(list, value("name") || node.id);
          if (device().type === "chino-config") RED.notify(t("editor.exported"), "warning");
        });
        part("import").on("click", () => part("file").val("").trigger("click"));
        part("file").on("change", async function() {
          try {
            const { count, doubt } = importTags(list, await this.files[0].text(), device());
            RED.notify(t("editor.imported", { number: count }), "success");
            if (doubt) RED.notify($("<span>").text(doubt).html(), { type: "warning", timeout: 15e3 });
          } catch (error) {
            RED.notify($("<span>").text(errorText(error)).html(), "error");
          }
        });
      };
      var lineProperties = (id) => {
        const line = RED.nodes.node(id);
        if (!line) return null;
        const names = Object.keys(line._def.defaults);
        return { id, ...Object.fromEntries(names.map((name) => [name, line[name]])) };
      };
      var withoutRemedy = (text) => text.split(/(?<=\.) (?=\S)/)[0];
      var failure = ({ reached, error }, short) => {
        const { deployFirst, value: path } = error.details || {};
        if (deployFirst) return t("test.deployFirst", { path });
        const text = short ? withoutRemedy(errorText(error)) : errorText(error);
        return reached ? t("test.reached", { text }) : t("test.failed", { text: text.replace(/^(?:the|station)\b/, capital) });
      };
      var sentences = (answer) => {
        const { ok, cause, error } = answer;
        if (ok) return [t(answer.value === null ? "test.noItem" : "test.ok", answer)];
        if (!cause || cause.code === error.code) return [failure(answer, false)];
        return [failure(answer, true), t("test.cause", { text: causeText(cause) })];
      };
      var showAnswer = (block, lines, colour) => block.show().empty().append(lines.map((line) => $("<div>").text(line))).css({ borderLeft: `4px solid var(${colour})` });
      var httpError = (xhr) => {
        const error = xhr.responseJSON && xhr.responseJSON.error || null;
        if (error) return { ok: false, error };
        const message = t(xhr.status === 401 || xhr.status === 403 ? "test.denied" : "test.unreachable");
        return { ok: false, error: { message } };
      };
      var wrongFields = ({ device }, node) => {
        const { type, ...settings } = device();
        return Object.entries(settings).map(([name, given]) => [name, field(name).length > 0 ? check(type, name).call(node, given) : true]).filter(([, verdict]) => typeof verdict === "string").map(([name, verdict]) => `${$(`label[for="${PREFIX}${name}"]`).first().text().trim()}: ${verdict}`);
      };
      var runTest = (own, node) => {
        const { part, list, device, url } = own;
        const button = part("test").prop("disabled", true);
        const result = part("test-result");
        const finish = (lines, colour = "--red-ui-text-color-error") => {
          button.prop("disabled", false);
          showAnswer(result, lines, colour);
        };
        if (device().type === "chino-config" && Number(value("station") || NaN) === 0) return finish([t("test.broadcast")]);
        showAnswer(result, [t("test.running")], "--red-ui-secondary-text-color");
        const data = JSON.stringify({
          plc: { id: node.id, ...device(), tags: tagRows(list) },
          line: lineProperties(value("line")),
          // one short read more, and RTU where ASCII is set, or the other way round, is told
          tryOtherModes: device().type === "chino-config"
        });
        $.ajax({ url, type: "POST", contentType: "application/json", data }).then(
          (answer) => finish(sentences(answer), answer.ok ? "--red-ui-text-color-success" : void 0),
          (xhr) => {
            const wrong = xhr.status === 400 ? wrongFields(own, node) : [];
            finish(wrong.length > 0 ? wrong : sentences(httpError(xhr)));
          }
        );
      };
      var TABS = {
        plc: "tab.plc",
        regulator: "tab.regulator",
        tags: "tab.tags",
        writing: "tab.writing",
        details: "tab.details"
      };
      var dialogHeight = 0;
      var fitTags = (list) => {
        if (dialogHeight > 0 && list.is(":visible")) list.editableList("height", Math.max(200, dialogHeight - 150));
      };
      var judgeRows = (list) => list.editableList("items").toArray().forEach((row) => row.data("nxline").judge());
      var deviceDialog = (name, { type, pages, fields, more = () => ({}), judged }) => {
        const part = (id) => $(`#nxline-${name}-${id}`);
        const device = () => ({ type, ...Object.fromEntries(fields.map((each) => [each, fieldValue(each)])), ...more() });
        const judge = () => judgeRows(part("tag-list"));
        return {
          /** oneditprepare; what `before` makes is there when the tags are judged. */
          edit(node, before = () => {
          }) {
            open(node, PREFIX);
            fillDefaults(node, PREFIX);
            before();
            const list = part("tag-list");
            tagTable(list, node.tags, device);
            const own = { part, list, device, url: `${type}/test` };
            wireCsv(own, node);
            part("test").on("click", () => runTest(own, node));
            judged.forEach((each) => field(each).on("change", judge));
            field("line").on("change", () => field("station").trigger("change"));
            field("access").on("change", function() {
              $(".nxline-writing").toggle($(this).val() !== "read");
              $(".nxline-reading").toggle($(this).val() === "read");
            }).trigger("change");
            part("tags").on("nxline-shown", () => {
              fitTags(list);
              judge();
            });
            tabs(
              `nxline-${name}-tabs`,
              pages.map((page) => [`nxline-${name}-${page}`, t(TABS[page])])
            );
          },
          /** oneditsave */
          save(node) {
            Object.assign(node, more(), { tags: tagRows(part("tag-list")) });
            done();
          },
          /** oneditresize */
          resize(size) {
            dialogHeight = size.height;
            fitTags(part("tag-list"));
          }
        };
      };
      module.exports = { deviceDialog, field, fieldValue, sentences, value };
    }
  });

  // scripts/editor/plc.js
  var require_plc = __commonJS({
    "scripts/editor/plc.js"(exports, module) {
      "use strict";
      var { areaMap } = require_areas();
      var { areaTable } = require_areas2();
      var { deviceDialog } = require_device();
      var { attempt, deviceLabel } = require_model();
      var { rowsOf } = require_table2();
      var { t } = require_texts();
      var areaRows = () => rowsOf($("#nxline-nx-area-list")).filter((row) => row.area);
      var dialog = deviceDialog("nx", {
        type: "nx-config",
        pages: ["plc", "tags", "writing", "details"],
        fields: ["name", "line", "station", "steps", "timeout", "masterIds"],
        more: () => ({ areas: areaRows() }),
        judged: ["steps"]
      });
      var noteAreas = () => {
        const map = attempt(() => areaMap(areaRows()), null);
        if (!map) return;
        const names = (sure) => map.list.filter((row) => row.certainty === "unconfirmed" === sure).map((row) => row.area);
        $("#nxline-nx-area-note").text(
          t("editor.areaNote", { sure: names(false).join(", "), unsure: names(true).join(", ") || "–" })
        );
      };
      var editPlc = (node) => dialog.edit(node, () => {
        areaTable($("#nxline-nx-area-list"), node.areas, noteAreas);
        noteAreas();
      });
      var plcLabel = (node) => deviceLabel({ type: "nx-config", station: node.station });
      module.exports = { editPlc, savePlc: dialog.save, resizePlc: dialog.resize, plcLabel };
    }
  });

  // scripts/editor/regulator.js
  var require_regulator = __commonJS({
    "scripts/editor/regulator.js"(exports, module) {
      "use strict";
      var { deviceDialog, field } = require_device();
      var { deviceLabel } = require_model();
      var { addTemplate } = require_tags2();
      var FIELDS = [
        ...[
          "name",
          "line",
          "station",
          "protocol",
          "timeout",
          "sendWait",
          "addressMode",
          "wordOrder",
          "broadcast",
          "turnaround"
        ],
        ...["coilRead", "coilUnit", "coilFunction", "coilWrite", "discreteRead", "discreteUnit", "inputRead"],
        ...["holdingRead", "holdingFunction", "holdingWrite"]
      ];
      var dialog = deviceDialog("chino", {
        type: "chino-config",
        pages: ["regulator", "tags", "writing", "details"],
        fields: FIELDS,
        judged: ["addressMode", "wordOrder"]
      });
      var editRegulatorConfig = (node) => {
        dialog.edit(node);
        $("#nxline-chino-template").on("click", () => addTemplate($("#nxline-chino-tag-list")));
        field("broadcast").on("change", () => field("station").trigger("change"));
        field("line").on("change", () => field("protocol").trigger("change"));
      };
      var regulatorLabel = (node) => deviceLabel({ type: "chino-config", station: node.station });
      module.exports = {
        editRegulatorConfig,
        saveRegulatorConfig: dialog.save,
        resizeRegulatorConfig: dialog.resize,
        regulatorLabel
      };
    }
  });

  // scripts/editor/form.js
  var require_form = __commonJS({
    "scripts/editor/form.js"(exports, module) {
      "use strict";
      var { open } = require_check();
      var { attempt, notationWithTags, parseItem } = require_model();
      var { fillDefaults } = require_widgets();
      var PREFIX = "node-input-";
      var field = (name) => $(`#${PREFIX}${name}`);
      var value = (name) => field(name).val();
      var DEVICES = {
        "nx-read": { property: "plc", of: "nx-config" },
        "nx-write": { property: "plc", of: "nx-config" },
        "chino-regulator": { property: "regulator", of: "chino-config" }
      };
      var form = DEVICES["nx-read"];
      var openForm = (type, node) => {
        form = DEVICES[type];
        open(node, PREFIX);
        fillDefaults(node, PREFIX);
      };
      var deviceProperty = () => form.property;
      var deviceOf = () => RED.nodes.node(value(form.property));
      var device = () => deviceOf() || { type: form.of };
      var notation = () => notationWithTags(device());
      var isModbus = () => form.of === "chino-config";
      var tagOffers = () => [...notation().tags.values()].map((tag) => ({
        value: tag.name,
        hint: [tag.address, tag.label, tag.unit].filter(Boolean).join(" · ")
      }));
      var isItem = (text) => attempt(() => Boolean(parseItem(text, notation())), false);
      var reads = () => form.of !== "chino-config" || value("mode") !== "write";
      var writes = () => form.of !== "chino-config" || value("mode") !== "read";
      var showsList = () => reads() && value("itemsType") === "list";
      module.exports = {
        PREFIX,
        device,
        deviceOf,
        deviceProperty,
        field,
        isItem,
        isModbus,
        notation,
        openForm,
        reads,
        showsList,
        tagOffers,
        value,
        writes
      };
    }
  });

  // lib/line/timing.js
  var require_timing = __commonJS({
    "lib/line/timing.js"(exports, module) {
      "use strict";
      var SLACK = Object.freeze({ serial: 50, tcp: 250, simulated: 50 });
      var FAST_GAP = 1.75;
      var bitsPerCharacter = ({ dataBits, parity, stopBits }) => 1 + dataBits + (parity === "none" ? 0 : 1) + stopBits;
      var characterTime = (settings) => bitsPerCharacter(settings) * 1e3 / settings.baudRate;
      var gapTime = (settings) => {
        if (settings.gap > 0) return settings.gap;
        return settings.baudRate > 19200 ? FAST_GAP : 3.5 * characterTime(settings);
      };
      var slackTime = (settings) => settings.slack || SLACK[settings.transport];
      var lineTimes = (settings) => ({
        character: characterTime(settings),
        gap: gapTime(settings),
        slack: slackTime(settings)
      });
      module.exports = { bitsPerCharacter, characterTime, gapTime, lineTimes, slackTime };
    }
  });

  // lib/device/chino-settings.js
  var require_chino_settings = __commonJS({
    "lib/device/chino-settings.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { TABLES, describeAddress } = require_address();
      var { planTableWrites, planTables } = require_plan();
      var { modbusNotation } = require_modbus_notation();
      var { TURNAROUND, blank, choice, isOn, nameOf, readHealth, readRanges, wholeNumber } = require_options();
      var LAST_STATION = 247;
      var MOST_SINGLES = 123;
      var NUMBERS = Object.freeze(
        /** @type {[string, number, number, number][]} */
        [
          ["timeout", 1e3, 10, 6e5],
          ["sendWait", 0, 0, 1e4],
          ["attempts", 3, 1, 20],
          ["coilRead", 2e3, 1, 2e3],
          ["coilUnit", 1, 1, 2e3],
          ["coilWrite", 1968, 1, 1968],
          ["discreteRead", 2e3, 1, 2e3],
          ["discreteUnit", 1, 1, 2e3],
          ["inputRead", 125, 1, 125],
          ["holdingRead", 125, 1, 125],
          ["holdingWrite", 123, 1, 123],
          ["turnaround", 100, 0, 1e4],
          ["writeInterval", 0, 0, 36e5],
          ["deadline", 0, 0, 36e5]
        ]
      );
      var CHOICES = Object.freeze({
        protocol: ["rtu", "ascii"],
        addressMode: ["1-base", "0-base"],
        coilFunction: ["0F", "05", "auto"],
        holdingFunction: ["10", "06", "auto"],
        wordOrder: ["low", "high"],
        byteOrder: ["high", "low"],
        access: ["read", "write"]
      });
      var readStation = (value, broadcast) => {
        const number = typeof value === "string" && /^\s*\d{1,3}\s*$/.test(value) ? Number(value) : value;
        if (typeof number !== "number" || !Number.isInteger(number) || number < 0 || number > LAST_STATION) {
          throw new PlcError("BAD_STATION", { station: value, reason: "it must be 1 to 247, or 0 for a broadcast" });
        }
        if (number === 0 && !broadcast) {
          throw new PlcError("BROADCAST_REFUSED", { what: "station 0", reason: "broadcasts are not allowed here" });
        }
        return number;
      };
      var plainSettings = (given) => {
        const settings = {};
        for (const [name, fallback, least, most] of NUMBERS) {
          settings[name] = wholeNumber(name, given[name], { fallback, least, most });
        }
        for (const [name, known] of Object.entries(CHOICES)) settings[name] = choice(name, readable(given[name]), known);
        for (const [unit, read] of [
          ["coilUnit", "coilRead"],
          ["discreteUnit", "discreteRead"]
        ]) {
          if (settings[unit] <= settings[read]) continue;
          const reason = `it is more than the max read count, ${settings[read]}`;
          throw new PlcError("BAD_SETTING", { setting: unit, value: settings[unit], reason });
        }
        return settings;
      };
      var readable = (value) => {
        if (typeof value !== "number" && typeof value !== "string") return value;
        const text = String(value).trim();
        const same = (each) => each.toLowerCase() === text.toLowerCase() || each === text.padStart(2, "0");
        return Object.values(CHOICES).flat().find(same) ?? value;
      };
      var readCount = (most, unit = 1) => most - most % unit;
      var tablesOf = (settings, costs) => {
        const { coilRead, coilUnit, discreteRead, discreteUnit, inputRead, holdingRead } = settings;
        const write = (chosen, count) => chosen === "05" || chosen === "06" ? MOST_SINGLES : count;
        const limits = {
          co: {
            unit: coilUnit,
            read: readCount(coilRead, coilUnit),
            write: write(settings.coilFunction, settings.coilWrite)
          },
          di: { unit: discreteUnit, read: readCount(discreteRead, discreteUnit), write: 0 },
          ir: { read: inputRead, write: 0 },
          hr: { read: holdingRead, write: write(settings.holdingFunction, settings.holdingWrite) }
        };
        return TABLES.map(({ table, kind, base, size }) => ({
          kind,
          from: base,
          to: base + size,
          ...costs,
          ...limits[table]
        }));
      };
      var LEAST_GAP = 1.75;
      var gapOf = ({ framing, sendWait }, { character, gap = 0 }) => Math.max(gap, sendWait, framing === "ascii" ? 0 : Math.max(LEAST_GAP, 3.5 * character));
      var costsOf = (framing, { gap, character, turnaround }) => {
        const wait = (gap + turnaround) / character;
        return framing === "ascii" ? { frameCost: 28 - 3 + wait, scale: 2 } : { frameCost: 13 - 3 + wait };
      };
      var SPLITS = /* @__PURE__ */ new Set(["MODBUS_ILLEGAL_ADDRESS", "MODBUS_ILLEGAL_VALUE"]);
      var ABSENT = /* @__PURE__ */ new Set(["MODBUS_ILLEGAL_ADDRESS"]);
      var planOf = (settings, times) => {
        const gap = gapOf(settings, times);
        const { character } = times;
        const tablesFor = (turnaround) => tablesOf(settings, costsOf(settings.framing, { gap, character, turnaround }));
        const tables = tablesFor(TURNAROUND);
        return {
          gap,
          silences: 1,
          reads: (points, { holes, turnaround = TURNAROUND } = {}) => planTables(points, tablesFor(turnaround), { holes }),
          writes: (points) => planTableWrites(points, tables),
          splits: SPLITS,
          absent: ABSENT,
          simpler: () => false
        };
      };
      var REASONS = Object.freeze({ area: "discrete inputs and input registers can only be read", throughWord: "" });
      var refuseBroadcast = (what, reason) => {
        throw new PlcError("BROADCAST_REFUSED", { what, reason });
      };
      var broadcastChecks = (station) => {
        if (station !== 0) return {};
        return {
          checkRead: () => refuseBroadcast("a read", "no station answers a broadcast"),
          checkWrite: ({ points, steps }, { verify }) => {
            if (steps.length > 0) refuseBroadcast(steps[0].text, "its largest step needs what each station holds now");
            const bit = points.find(({ through }) => through);
            if (bit) refuseBroadcast(bit.text, "one bit of a register is written by reading the register first");
            if (verify) refuseBroadcast("a write that is read back", "no station answers a broadcast");
          }
        };
      };
      var readSettings = (given, character = 0.52, lineGap = 0) => {
        const broadcast = isOn(given.broadcast);
        const station = readStation(given.station, broadcast);
        const { protocol: framing, ...settings } = plainSettings(given);
        const { addressMode, wordOrder, byteOrder, coilFunction, holdingFunction, turnaround } = settings;
        const notation = modbusNotation({ addressMode, tags: given.tags, wordOrder, byteOrder });
        return {
          ...settings,
          ...readHealth(given),
          protocol: "modbus",
          framing,
          station,
          name: blank(given.name) && station === 0 ? "all stations" : nameOf(given.name, station),
          probe08: isOn(given.probe08),
          broadcast: broadcast ? { turnaround } : null,
          ranges: readRanges(given.writableRanges, notation),
          notation,
          reasons: REASONS,
          functions: { co: coilFunction, hr: holdingFunction },
          units: { 1: settings.coilUnit, 2: settings.discreteUnit },
          describe: (place, { write }) => describeAddress(place, { write, coilFunction, holdingFunction }),
          plan: planOf({ ...settings, framing }, { character, gap: lineGap }),
          ...broadcastChecks(station)
        };
      };
      module.exports = { readSettings, readStation };
    }
  });

  // lib/tag/value.js
  var require_value = __commonJS({
    "lib/tag/value.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { absurdity, elementsOf, toNumber } = require_convert();
      var decimals = (number) => {
        const [mantissa, exponent = "0"] = String(Math.abs(number)).split("e");
        return Math.max(0, (mantissa.split(".")[1] || "").length - Number(exponent));
      };
      var scaled = (tag) => Boolean(tag) && (tag.scale !== 1 || tag.offset !== 0);
      var toEngineering = (raw, tag, integer) => {
        const value = raw * tag.scale + tag.offset;
        const places = Math.max(decimals(tag.scale), decimals(tag.offset));
        return integer && places <= 15 ? Number(value.toFixed(places)) : Number(value.toPrecision(15));
      };
      var toRaw = (value, tag) => Number(((value - tag.offset) / tag.scale).toPrecision(15));
      var decodeValue = (item, raw) => {
        const answer = item.type.decode(raw, item);
        if ("bad" in answer) {
          const error = new PlcError("NOT_A_VALUE", { item: item.text, type: item.type.name, reason: answer.bad });
          return { code: "NOT_A_VALUE", text: error.message };
        }
        if (!scaled(item.tag)) return answer;
        return { value: toEngineering(answer.value, item.tag, item.type.integer) };
      };
      var checkLimits = (item, number, value) => {
        const { min = null, max = null } = item.tag ?? {};
        if (min !== null && number < min || max !== null && number > max) {
          throw new PlcError("VALUE_OUT_OF_RANGE", {
            item: item.text,
            value,
            least: min ?? "any",
            most: max ?? "any"
          });
        }
      };
      var engineeringRange = ({ tag, type }) => {
        const ends = [type.least, type.most].map((raw) => toEngineering(raw, tag, type.integer)).sort((a, b) => a - b);
        return { least: ends[0], most: ends[1] };
      };
      var encodeOne = (item, value) => {
        const { type, tag, text, wordOrder, byteOrder } = item;
        if (!type.numeric) return type.encode(value, { item: text, wordOrder, byteOrder });
        const number = toNumber(value, text);
        checkLimits(item, number, value);
        if (!scaled(tag)) return type.encode(number, { item: text, wordOrder });
        try {
          const raw = type.encode(toRaw(number, tag), { item: text, wordOrder, rounds: true });
          const out = (
            /** @type {{ value: number }} */
            type.decode(raw, item).value
          );
          checkLimits(item, toEngineering(out, tag, type.integer), value);
          return raw;
        } catch (caught) {
          const error = (
            /** @type {PlcError} */
            caught
          );
          if (error.code !== "VALUE_OUT_OF_RANGE" || error.details.value === value) throw error;
          throw new PlcError("VALUE_OUT_OF_RANGE", { item: text, value, ...engineeringRange(item) });
        }
      };
      var encodeValue = (item, value) => {
        const absurd = absurdity(value);
        if (absurd && value !== "") throw new PlcError("BAD_VALUE", { item: item.text, value, reason: absurd });
        if (!item.range) {
          if (Array.isArray(value)) throw new PlcError("BAD_VALUE", { item: item.text, value, reason: "it takes one value" });
          return [encodeOne(item, value)];
        }
        if (!Array.isArray(value) || value.length !== item.count) {
          throw new PlcError("BAD_VALUE", { item: item.text, value, reason: `it takes an array of ${item.count} values` });
        }
        return elementsOf(value).map((one) => encodeOne(item, one));
      };
      module.exports = { decodeValue, encodeValue };
    }
  });

  // lib/device/points.js
  var require_points = __commonJS({
    "lib/device/points.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { splitType } = require_item();
      var { decodeValue } = require_value();
      var MOST_POINTS = 2e4;
      var WORD = 16;
      var widthOf = (item) => item.packed ? item.type.words * WORD : item.type.words;
      var pointOf = (item, index) => {
        const { kind, address } = item;
        if (item.throughWord) return { kind: "word", address: address + index >> 4, count: 1 };
        const count = widthOf(item);
        return { kind, address: address + index * count, count };
      };
      var writtenAs = (item) => item.tag ? item.text : splitType(item.text.trim())[0];
      var packed = (bits) => Array.from(
        { length: bits.length / WORD },
        (_, word) => bits.slice(word * WORD, (word + 1) * WORD).reduce((sum, bit, at) => sum | (bit ? 1 << at : 0), 0)
      );
      var unpacked = (words) => words.flatMap((word) => Array.from({ length: WORD }, (_, at) => Boolean(word >> at & 1)));
      var writePointsOf = ({ item, values }) => {
        const width = widthOf(item);
        return values.map((raw, index) => ({
          kind: item.kind,
          address: item.address + index * width,
          values: item.packed ? unpacked(raw) : raw,
          count: width,
          text: item.range ? item.elements[index].text : writtenAs(item),
          through: item.throughWord
        }));
      };
      var readBackOf = ({ kind, address, count, text, through }) => through ? { kind: (
        /** @type {'word'} */
        "word"
      ), address: address >> 4, count: 1, text } : { kind, address, count, text };
      var readBackValues = ({ address, through }, raw) => through ? [Boolean(raw[0] >> (address & 15) & 1)] : raw;
      var checkTotal = (items) => {
        const total = items.reduce((sum, item) => sum + item.count * widthOf(item), 0);
        if (total > MOST_POINTS) throw new PlcError("TOO_MANY", { count: total, unit: "addresses", most: MOST_POINTS });
      };
      var pointsOf = (items) => {
        checkTotal(items);
        return items.flatMap(
          (item) => item.elements.map(({ text }, index) => ({ ...pointOf(item, index), text: item.range ? text : writtenAs(item) }))
        );
      };
      var rawOf = (item, index, raw) => {
        if (item.packed) return packed(raw);
        if (!item.throughWord) return raw;
        return readBackValues({ address: item.address + index, through: item.throughWord }, raw);
      };
      var elementOf = (item, index, reading) => {
        const name = item.range ? item.elements[index].name : item.name;
        const timestamp = reading.at;
        if ("error" in reading) {
          const { code, message } = reading.error;
          return { name, timestamp, value: null, quality: "bad", code, text: message };
        }
        const answer = decodeValue(item, rawOf(item, index, reading.raw));
        if ("code" in answer) return { name, timestamp, value: null, quality: "bad", code: answer.code, text: answer.text };
        return { name, timestamp, value: answer.value, quality: "good" };
      };
      var arrayOf = (item, elements) => {
        const bad = elements.find((element) => element.quality === "bad");
        const value = bad && elements.every((element) => element.quality === "bad") ? null : elements.map((each) => each.value);
        const timestamp = elements.reduce((least, element) => Math.min(least, element.timestamp), Infinity);
        const result = { name: item.name, value, quality: bad ? "bad" : "good", timestamp, elements };
        return bad ? { ...result, code: bad.code, text: bad.text } : result;
      };
      var deadbandOf = ({ tag }) => tag ? tag.deadband : 0;
      var described = (item, result) => {
        const { text, label, unit } = item;
        return Object.assign(result, { item: text, label, unit, deadband: deadbandOf(item) });
      };
      var singleOf = (item, reading) => {
        if ("error" in reading) return described(item, elementOf(item, 0, reading));
        const answer = decodeValue(item, rawOf(item, 0, reading.raw));
        if ("code" in answer) return described(item, elementOf(item, 0, reading));
        const { name, text, label, unit } = item;
        const { value } = answer;
        const deadband = deadbandOf(item);
        return { name, timestamp: reading.at, value, quality: "good", item: text, label, unit, deadband };
      };
      var resultsOf = (items, readings) => {
        let next = 0;
        return items.map((item) => {
          if (!item.range) return singleOf(item, readings[next++]);
          const elements = item.elements.map((_, index) => elementOf(item, index, readings[next++]));
          return described(item, arrayOf(item, elements));
        });
      };
      module.exports = {
        MOST_POINTS,
        checkTotal,
        packed,
        pointsOf,
        readBackOf,
        readBackValues,
        resultsOf,
        widthOf,
        writePointsOf
      };
    }
  });

  // lib/device/predict.js
  var require_predict = __commonJS({
    "lib/device/predict.js"(exports, module) {
      "use strict";
      var { PlcError } = require_error();
      var { lineTimes } = require_timing();
      var { loadOf } = require_plan();
      var { parseItem } = require_item();
      var { readSettings: readChino } = require_chino_settings();
      var { pointsOf } = require_points();
      var { readSettings: readNx } = require_settings();
      var READERS = { nx: readNx, chino: readChino };
      var timesOf = ({ baudRate = 19200, dataBits = 8, parity = "none", stopBits = 1, gap = 0 }) => {
        const numbers = {
          baudRate: Number(baudRate),
          dataBits: Number(dataBits),
          stopBits: Number(stopBits),
          gap: Number(gap)
        };
        return lineTimes({ ...numbers, parity, slack: 0, transport: "serial" });
      };
      var groupsOf = (asked) => {
        const groups = /* @__PURE__ */ new Map();
        for (const { interval, points } of asked) groups.set(interval, [...groups.get(interval) ?? [], ...points]);
        return [...groups].map(([interval, points]) => ({ interval, points }));
      };
      var stationLoad = ({ device = "nx", settings: given, subscriptions }, times) => {
        const read = READERS[device];
        if (!read) throw new PlcError("BAD_SETTING", { setting: "device", value: device, reason: "known are nx, chino" });
        const { plan, notation, station } = read(given, times.character, times.gap);
        const wire = { requestsOf: (points) => plan.reads(points), ...times, gap: plan.gap, silences: plan.silences };
        const asked = subscriptions.map(({ items, interval, name = "" }) => {
          const points = pointsOf(items.map((text) => parseItem(text, notation)));
          const alone = loadOf([{ interval, points }], wire);
          const [{ ms, requests }] = alone.cycles;
          return { name, station, interval, points, ms, requests, percent: alone.percent };
        });
        return { station, ...loadOf(groupsOf(asked), wire), asked: asked.map(({ points: _points, ...row }) => row) };
      };
      var predict = ({ line, stations }) => {
        const times = timesOf(line);
        const loads = stations.map((station) => stationLoad(station, times));
        const sum = (key) => loads.reduce((total, load) => total + load[key], 0);
        const asked = loads.flatMap((load) => load.asked);
        const asksMost = asked.reduce((most, each) => most && most.percent >= each.percent ? most : each, asked[0] ?? null);
        return { percent: sum("percent"), busyPercent: sum("busyPercent"), asksMost, stations: loads };
      };
      module.exports = { predict };
    }
  });

  // scripts/editor/cost.js
  var require_cost = __commonJS({
    "scripts/editor/cost.js"(exports, module) {
      "use strict";
      var { predict } = require_predict();
      var { device, isItem, isModbus, reads, showsList, value } = require_form();
      var { attempt } = require_model();
      var { say } = require_widgets();
      var { t } = require_texts();
      var MOST = 90;
      var LIMITS = ["readWords", "readBits"];
      var plain = (settings) => Object.fromEntries(
        Object.entries(settings).filter(
          ([, given]) => given !== "" && !(typeof given === "string" && given.startsWith("${"))
        )
      );
      var settingsOf = ({ station, ...given }) => {
        const known = plain(given);
        const limits = Object.fromEntries(LIMITS.filter((limit) => known[limit]).map((limit) => [limit, Number(known[limit])]));
        return {
          ...known,
          station: Number(station) || 1,
          access: "read",
          writableRanges: "",
          ...isModbus() ? {} : { limits }
        };
      };
      var costOf = (items) => {
        const interval = Number(value("interval"));
        const good = items.filter(isItem);
        if (!(interval >= 10) || good.length === 0) return null;
        const settings = device();
        const line = plain(RED.nodes.node(settings.line) || {});
        const subscriptions = [{ items: good, interval }];
        const stations = [{ device: isModbus() ? "chino" : "nx", settings: settingsOf(settings), subscriptions }];
        return attempt(
          () => predict({ line: (
            /** @type {any} */
            line
          ), stations: (
            /** @type {any} */
            stations
          ) }).asksMost,
          null
        );
      };
      var round = (number) => number < 10 ? Math.round(number * 10) / 10 : Math.round(number);
      var showCost = (items) => {
        const block = $("#nxline-read-cost");
        const cost = showsList() ? costOf(items) : null;
        if (!cost) return block.empty();
        const { percent, ms, requests } = cost;
        const figures = { ms: round(percent * 10), percent: round(percent), cycle: round(ms), requests };
        const more = percent > MOST ? ` ${t("editor.readCostMore")}` : "";
        return say(block, t("editor.readCost", figures) + more, percent > MOST);
      };
      var showSilence = () => $(".nxline-silence").toggle(reads() && value("report") !== "all");
      module.exports = { showCost, showSilence };
    }
  });

  // scripts/editor/reading.js
  var require_reading = __commonJS({
    "scripts/editor/reading.js"(exports, module) {
      "use strict";
      var { isVariable } = require_check();
      var {
        device,
        deviceOf,
        deviceProperty,
        field,
        isItem,
        isModbus,
        notation,
        showsList,
        tagOffers,
        value
      } = require_form();
      var { attempt, describe, deviceName, parseItem, unsure } = require_model();
      var { showCost, showSilence } = require_cost();
      var { copyable, flex, note, say, suggest } = require_widgets();
      var { errorText, t } = require_texts();
      var itemTexts = () => $("#nxline-read-items").editableList("items").toArray().map((row) => row.data("nxline").read()).filter((text) => text !== "");
      var verdictOf = (text) => {
        if (!text) return { says: t("editor.itemHint") };
        if (isVariable(text)) return { says: t("editor.variable") };
        const known = notation();
        try {
          const item = parseItem(text, known);
          const sure = unsure(item, known) ? ` · ${t("editor.unconfirmed")}` : "";
          const key = value("format") === "object" ? `msg.payload.${item.name}` : item.name;
          return { says: `${describe(item, device())}${sure} · `, key };
        } catch (error) {
          return { says: errorText(error), bad: true };
        }
      };
      var judgeItem = (text, block) => {
        const verdict = verdictOf(text);
        const signature = JSON.stringify(verdict);
        if (block.data("nxline") === signature) return;
        say(block, verdict.says, verdict.bad).data("nxline", signature);
        if (verdict.key) block.append(copyable(verdict.key));
      };
      var addItem = (container, data) => {
        const input = $('<input type="text" class="nxline-item">').css({ flexGrow: 1, margin: 0 }).attr({
          placeholder: t(isModbus() ? "editor.modbusAddress" : "editor.itemExample"),
          "aria-label": t("editor.item")
        }).val(typeof data === "string" ? data : data.text || "");
        const message = note();
        const read = () => String(input.val()).trim();
        const judge = () => judgeItem(read(), message);
        container.append(flex(input)).append(message);
        suggest(input, tagOffers, isItem);
        input.on("input change", () => {
          judge();
          showExample();
        });
        container.data("nxline", { read, judge });
        judge();
      };
      var judgeAll = () => {
        const rows = $("#nxline-read-items").editableList("items").toArray();
        rows.forEach((row) => row.data("nxline").judge());
        showExample();
      };
      var SAMPLES = { bool: true, float32: 21.5 };
      var sampleOf = (item, index) => {
        const one = item.type.name.startsWith("string") ? "ABC" : SAMPLES[item.type.name] ?? 120 + index;
        const plain = one === true && value("booleans") === "number" ? 1 : one;
        return item.range && value("ranges") === "array" ? Array.from({ length: Math.min(item.count, 3) }, () => plain) : plain;
      };
      var singles = (item) => item.range && value("ranges") === "values" ? item.elements.map(({ name }) => ({ ...item, name })) : [item];
      var EXAMPLES = {
        object: (rows, topic) => ({ topic, payload: Object.fromEntries(rows) }),
        message: ([[name, one]]) => ({ topic: name, payload: one }),
        envelope: ([[name, one]]) => ({
          topic: name,
          payload: { value: one, quality: "good", timestamp: 17672256e5, unit: "" }
        }),
        list: (rows, topic) => ({
          topic,
          payload: rows.map(([name, one]) => ({ name, value: one, quality: "good", timestamp: 17672256e5, unit: "" }))
        })
      };
      var showExample = () => {
        showCost(itemTexts());
        const known = notation();
        const items = itemTexts().flatMap((text2) => attempt(() => singles(parseItem(text2, known)), []));
        const rows = items.slice(0, 3).map((item, index) => [item.name, sampleOf(item, index)]);
        const shape = EXAMPLES[value("format")];
        const block = $("#nxline-read-example");
        if (rows.length === 0 || !shape || !showsList()) return block.parent().hide();
        const named = deviceOf();
        const text = JSON.stringify(shape(rows, named ? deviceName(named) : "PLC"));
        block.text(items.length > 3 ? `${text} …` : text);
        return block.parent().show();
      };
      var prepareReading = (node) => {
        const list = $("#nxline-read-items").editableList({
          addItem: (container, _index, data) => addItem(container, data),
          removeItem: () => setTimeout(showExample, 0),
          addButton: t("editor.addItem"),
          removable: true,
          sortable: true,
          height: 240
        });
        (node.items || []).forEach((text) => list.editableList("addItem", { text }));
        if (!node.items || node.items.length === 0) list.editableList("addItem", { text: "" });
        setTimeout(() => list.closest(".red-ui-editableList-container").scrollTop(0), 0);
        field("itemsType").on("change", () => {
          $(".nxline-list").toggle(showsList());
          showExample();
        }).trigger("change");
        field("interval").on("input change", () => showCost(itemTexts()));
        field("report").on("change", showSilence);
        showSilence();
        [deviceProperty(), "format", "ranges", "booleans"].forEach((name) => field(name).on("change", judgeAll));
        judgeAll();
      };
      var room = 0;
      var fitList = () => {
        if (room === 0 || !showsList()) return;
        const others = $("#dialog-form > div:visible").not(".nxline-list").toArray();
        const used = others.reduce((sum, row) => sum + $(row).outerHeight(true), 0);
        const least = $(".nxline-both").is(":visible") ? 200 : 240;
        $("#nxline-read-items").editableList("height", Math.max(least, room - used - 100));
      };
      var resizeRead = (size) => {
        room = size.height;
        fitList();
      };
      var readLabel = (node) => {
        if (node.itemsType === "msg") return "msg.items";
        const items = node.items || [];
        return items.length > 2 ? `${items.slice(0, 2).join(", ")} …` : items.join(", ");
      };
      module.exports = { fitList, itemTexts, prepareReading, readLabel, resizeRead };
    }
  });

  // scripts/editor/writing.js
  var require_writing = __commonJS({
    "scripts/editor/writing.js"(exports, module) {
      "use strict";
      var { isVariable } = require_check();
      var { PREFIX, device, deviceOf, deviceProperty, field, isItem, notation, tagOffers, value } = require_form();
      var { canOnlyBeRead, describe, deviceName, parseItem } = require_model();
      var { say, suggest } = require_widgets();
      var { errorText, t } = require_texts();
      var targetVerdict = (text) => {
        const named = deviceOf();
        const readOnly = named && named.access !== "write" ? t("problem.readOnly", { plc: deviceName(named) }) : "";
        if (!text) return readOnly ? { says: readOnly, bad: true } : { says: t("editor.noTarget") };
        if (isVariable(text)) return { says: t("editor.variable") };
        try {
          const item = parseItem(text, notation());
          if (readOnly) return { says: readOnly, bad: true };
          return { says: describe(item, device(), { write: true }), bad: canOnlyBeRead(item, device()) };
        } catch (error) {
          return { says: errorText(error), bad: true };
        }
      };
      var judgeTarget = () => {
        const { says, bad } = targetVerdict(String(value("target") || "").trim());
        say($("#nxline-write-note"), says, bad);
      };
      var prepareWriting = () => {
        suggest(field("target"), tagOffers, isItem);
        $(`#${PREFIX}target, #${PREFIX}${deviceProperty()}`).on("input change", judgeTarget);
        field(deviceProperty()).on("change", () => field("target").trigger("change"));
        field("topic").on("change", () => field("topicText").toggle(value("topic") === "fixed")).trigger("change");
        judgeTarget();
      };
      var failureOutputs = () => value("onFailure") === "output" ? 1 : 0;
      var writeLabel = (node) => node.target || "";
      module.exports = { failureOutputs, prepareWriting, writeLabel };
    }
  });

  // scripts/editor/flow.js
  var require_flow = __commonJS({
    "scripts/editor/flow.js"(exports, module) {
      "use strict";
      var { done } = require_check();
      var { field, openForm, reads, value, writes } = require_form();
      var { fitList, itemTexts, prepareReading, readLabel, resizeRead } = require_reading();
      var { failureOutputs, prepareWriting, writeLabel } = require_writing();
      var editRead = (node) => {
        openForm("nx-read", node);
        prepareReading(node);
      };
      var saveRead = (node) => {
        node.items = itemTexts();
        done();
      };
      var editWrite = (node) => {
        openForm("nx-write", node);
        prepareWriting();
      };
      var saveWrite = (node) => {
        node.outputs = 1 + failureOutputs();
        done();
      };
      var showMode = () => {
        $(".nxline-reads").toggle(reads());
        $(".nxline-writes").toggle(writes());
        $(".nxline-both").toggle(value("mode") === "both");
        ["itemsType", "target", "interval", "report"].forEach((name) => field(name).trigger("change"));
        fitList();
      };
      var editRegulator = (node) => {
        openForm("chino-regulator", node);
        prepareReading(node);
        prepareWriting();
        field("mode").on("change", showMode);
        showMode();
      };
      var saveRegulator = (node) => {
        node.items = itemTexts();
        node.outputs = (reads() ? 1 : 0) + (writes() ? 1 + failureOutputs() : 0);
        done();
      };
      var outputRole = (mode, index) => {
        const roles = { read: ["values"], write: ["confirmed", "failed"], both: ["values", "confirmed", "failed"] };
        return (roles[mode] || roles.read)[index];
      };
      var modeLabel = (node) => node.mode === "write" ? writeLabel(node) : readLabel(node);
      module.exports = {
        editRead,
        saveRead,
        resizeRead,
        readLabel,
        editWrite,
        saveWrite,
        writeLabel,
        editRegulator,
        saveRegulator,
        modeLabel,
        outputRole
      };
    }
  });

  // scripts/editor/listener.js
  var require_listener = __commonJS({
    "scripts/editor/listener.js"(exports, module) {
      "use strict";
      var { done, open } = require_check();
      var { fillDefaults, say, tabs } = require_widgets();
      var { t } = require_texts();
      var PREFIX = "node-input-";
      var field = (name) => $(`#${PREFIX}${name}`);
      var value = (name) => field(name).val();
      var isTicked = (name) => field(name).prop("checked");
      var PAGES = {
        messages: "tab.messages",
        sending: "tab.sending",
        details: "tab.details"
      };
      var NAMES = { "0D": "CR", "0A": "LF", "02": "STX", "03": "ETX", "04": "EOT", 10: "DLE", "00": "NUL" };
      var bytesByName = (text) => (String(text).toUpperCase().match(/[0-9A-F]{2}/g) || []).map((byte) => NAMES[byte] || `${byte}h`).join(" ");
      var noteEnd = () => {
        const name = bytesByName(value("end"));
        say($("#nxline-c24-end"), name ? t("editor.ends", { name }) : t("editor.noEnd"), !name && !value("last"));
      };
      var showC24 = () => {
        const twoWay = isTicked("bidirectional");
        const framing = value("framing");
        $(".nxline-two-way").toggle(twoWay);
        $(".nxline-free").toggle(!twoWay);
        $("#nxline-c24-gap").text(t(twoWay ? "editor.gapAuto" : framing === "gap" ? "editor.gapEnds" : "editor.gapTorn"));
        for (const each of ["end", "count"]) $(`.nxline-framing-${each}`).toggle(!twoWay && framing === each);
        $(".nxline-text").toggle(value("format") === "text");
        $(".nxline-words").toggle(value("format") === "words" || twoWay);
        $(".nxline-dc").toggle(value("flow") === "dc");
        $(".nxline-driver").toggle(value("flow") === "driver");
        $(".nxline-held").toggle(value("flow") !== "none");
      };
      var showLink = () => {
        const checked = isTicked("checked");
        if (!checked) field("acknowledge").prop("checked", false);
        const acks = isTicked("acknowledge");
        $(".nxline-checked").toggle(checked);
        $(".nxline-acks").toggle(acks);
        $(".nxline-pauses").toggle(acks || value("access") !== "read");
      };
      var SHOW = { "melsec-c24": showC24, "incon-link": showLink };
      var showAccess = () => {
        const sends = value("access") !== "read";
        if (!sends) $(".nxline-sends").hide();
        else $(".nxline-sends").not(".nxline-free, .nxline-two-way").show();
        $(".nxline-silent").toggle(!sends);
      };
      var COUNTS = ["end", "count", "gap", "flow"];
      var editListener = (node) => {
        const { type } = node;
        open(node, PREFIX);
        fillDefaults(node, PREFIX);
        const show = () => {
          SHOW[type]();
          showAccess();
        };
        const deciding = ["bidirectional", "framing", "format", "flow", "checked", "acknowledge", "access"];
        for (const name of deciding) field(name).on("change", show);
        for (const name of ["bidirectional", "framing"])
          field(name).on("change", () => COUNTS.forEach((each) => field(each).trigger("change")));
        if (type === "melsec-c24") {
          $("#node-input-end, #node-input-last").on("input change", noteEnd);
          noteEnd();
        }
        const pages = Object.keys(PAGES).filter((page) => $(`#nxline-${type}-${page}`).length > 0);
        tabs(
          `nxline-${type}-tabs`,
          pages.map((page) => [`nxline-${type}-${page}`, t(PAGES[page])])
        );
        show();
      };
      var saveListener = (node) => {
        const sends = value("access") !== "read";
        node.outputs = sends ? 2 + (value("onFailure") === "output" ? 1 : 0) : 1;
        done();
      };
      module.exports = { bytesByName, editListener, saveListener };
    }
  });

  // scripts/editor/monitor.js
  var require_monitor = __commonJS({
    "scripts/editor/monitor.js"(exports, module) {
      "use strict";
      var { done, open } = require_check();
      var { fillDefaults } = require_widgets();
      var PREFIX = "node-input-";
      var editMonitor = (node) => {
        open(node, PREFIX);
        fillDefaults(node, PREFIX);
      };
      var saveMonitor = (node) => {
        node.outputs = $(`#${PREFIX}trace`).prop("checked") ? 3 : 2;
        done();
      };
      module.exports = { editMonitor, saveMonitor };
    }
  });

  // scripts/editor/index.js
  var require_index = __commonJS({
    "scripts/editor/index.js"(exports, module) {
      module.exports = {
        check: require_check().check,
        done: require_check().done,
        ...require_line(),
        ...require_plc(),
        ...require_regulator(),
        ...require_flow(),
        editListener: require_listener().editListener,
        saveListener: require_listener().saveListener,
        ...require_monitor()
      };
    }
  });
  return require_index();
})();
