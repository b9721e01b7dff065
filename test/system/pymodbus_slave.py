"""Stations of pymodbus on one serial port or TCP port, for the system tests.

    python pymodbus_slave.py --framer rtu|ascii (--port PATH | --tcp) --stations 11,12

Prints one JSON line `{"ready": ...}`, then answers each JSON line on stdin with one on stdout: the tests' own way to the registers.
    {"do": "set", "station": 11, "table": "hr", "base": 0, "values": [1, 2]}
    {"do": "get", "station": 11, "table": "hr", "base": 0, "count": 2}
    {"do": "refuse", "station": 11, "base": 700, "code": 6, "times": 1}    requests that touch this address get an exception
    {"do": "absent", "silent": true}    stations that are not there: silence, or pymodbus' own exception 4
    {"do": "log"}    what was carried out since the last time, as [station, function, base, count]
"""

import argparse
import asyncio
import functools
import json
import sys

from pymodbus import FramerType
from pymodbus.constants import ExcCodes
from pymodbus.exceptions import NoSuchIdException
from pymodbus.server import ModbusSerialServer, ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice

SIZE = 65536
READ = {"co": 1, "di": 2, "hr": 3, "ir": 4}
WRITTEN_WITH = {"co": 15, "di": 2, "hr": 16, "ir": 4}


class State:
    """What the control channel changes."""

    def __init__(self):
        self.quiet = False
        self.silent = True
        self.refusals = []
        self.log = []


async def action(state, station, asked, function, _start, address, _words, _registers, values):
    """Called by pymodbus for each access, with the address of the request."""
    if state.quiet:
        return None
    for refusal in state.refusals:
        if refusal["station"] == station and address <= refusal["base"] < address + asked and refusal["times"]:
            refusal["times"] -= 1
            return ExcCodes(refusal["code"])
    # 05 and 06 look at what they have written
    if values is not None or function <= 4:
        state.log.append([station, function, address, asked])
    return None


class Stations:
    """The datastore of pymodbus, with the number asked for (pymodbus tells its action only whole words) and silence for absent stations."""

    def __init__(self, core, state):
        self.core = core
        self.state = state

    def device_ids(self):
        return self.core.device_ids()

    def check(self, station):
        if self.state.silent and station not in self.core.devices:
            raise NoSuchIdException("not here")

    def asks(self, station, count):
        device = self.core.devices.get(station)
        if device:
            device.action = functools.partial(action, self.state, station, count)

    async def async_getValues(self, station, function, address, count=1):
        self.check(station)
        self.asks(station, count)
        return await self.core.async_getValues(station, function, address, count)

    async def async_setValues(self, station, function, address, values):
        self.check(station)
        self.asks(station, len(values))
        return await self.core.async_setValues(station, function, address, values)


def device(station):
    bits = lambda: [SimData(0, values=[False] * SIZE, datatype=DataType.BITS)]
    words = lambda: [SimData(0, count=SIZE, values=0, datatype=DataType.REGISTERS)]
    return SimDevice(station, simdata=(bits(), bits(), words(), words()))


async def control(server, state, order):
    what = order["do"]
    if what == "log":
        log, state.log = state.log, []
        return log
    if what == "absent":
        state.silent = order["silent"]
        return True
    if what == "refuse":
        state.refusals.append({"times": 1, **order})
        return True
    state.quiet = True
    try:
        table, station = order["table"], order["station"]
        if what == "get":
            return await server.context.async_getValues(station, READ[table], order["base"], order["count"])
        result = await server.context.async_setValues(station, WRITTEN_WITH[table], order["base"], order["values"])
        return result is None
    finally:
        state.quiet = False


def build(options, state):
    devices = [device(int(text)) for text in options.stations.split(",")]
    common = {"framer": FramerType(options.framer), "broadcast_enable": True, "ignore_missing_devices": True}
    if options.tcp:
        server = ModbusTcpServer(devices, address=("127.0.0.1", 0), **common)
    else:
        server = ModbusSerialServer(devices, port=options.port, baudrate=115200, **common)
    server.context = Stations(server.context, state)
    return server


async def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--framer", required=True)
    parser.add_argument("--port")
    parser.add_argument("--tcp", action="store_true")
    parser.add_argument("--stations", required=True)
    options = parser.parse_args()
    state = State()
    server = build(options, state)
    await server.serve_forever(background=True)
    port = server.transport.sockets[0].getsockname()[1] if options.tcp else options.port
    print(json.dumps({"ready": port}), flush=True)

    reader = asyncio.StreamReader()
    await asyncio.get_running_loop().connect_read_pipe(lambda: asyncio.StreamReaderProtocol(reader), sys.stdin)
    # the end of stdin is the end of the test
    while line := await reader.readline():
        try:
            answer = {"is": await control(server, state, json.loads(line))}
        except Exception as error:  # told to the test
            answer = {"error": repr(error)}
        print(json.dumps(answer), flush=True)
    await server.shutdown()


asyncio.run(main())
