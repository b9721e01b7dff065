#!/usr/bin/env python3
"""A MODBUS master written from the protocol alone: own CRC and LRC, own frames, standard library only.

    independent_modbus_client.py HOST:PORT|PATH rtu|ascii BAUD

Checks two simulated regulators with the numbers 11 and 12, whose memory starts at 0, and where holding registers 500..509 and
coil 5 (numbers on the wire) are protected. Prints one line per check, and at last "ok N".
"""

import os
import select
import socket
import sys
import termios
import time

WAIT = 2.0       # seconds until an answer must be there
SILENCE = 0.15   # seconds after which nobody has answered
checks = 0
ascii_mode = sys.argv[2] == "ascii"


def crc(data):
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = (value >> 1) ^ 0xA001 if value & 1 else value >> 1
    return bytes([value & 0xFF, value >> 8])


def lrc(data):
    return (0x100 - sum(data) % 0x100) & 0xFF


# the worked examples of the panel's manual
assert crc(bytes.fromhex("1103006B0003")) == bytes.fromhex("7687")
assert lrc(bytes.fromhex("1103006B0003")) == 0x7E


def frame(body):
    body = bytes(body)
    if ascii_mode:
        return b":" + (body + bytes([lrc(body)])).hex().upper().encode() + b"\r\n"
    return body + crc(body)


class Serial:
    def __init__(self, path):
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY)
        mode = termios.tcgetattr(self.fd)
        mode[0] = mode[1] = mode[3] = 0
        mode[2] = termios.CS8 | termios.CREAD | termios.CLOCAL
        mode[4] = mode[5] = termios.B38400
        mode[6][termios.VMIN] = 1
        mode[6][termios.VTIME] = 0
        termios.tcsetattr(self.fd, termios.TCSANOW, mode)
        termios.tcflush(self.fd, termios.TCIOFLUSH)

    def write(self, data):
        os.write(self.fd, data)

    def read(self, wait):
        ready, _, _ = select.select([self.fd], [], [], wait)
        return os.read(self.fd, 4096) if ready else b""


class Tcp:
    def __init__(self, address):
        host, port = address.rsplit(":", 1)
        self.socket = socket.create_connection((host, int(port)))
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def write(self, data):
        self.socket.sendall(data)

    def read(self, wait):
        ready, _, _ = select.select([self.socket], [], [], wait)
        return self.socket.recv(4096) if ready else b""


def receive(port, length):
    """The body of an answer with `length` bytes (an exception has 3), its check code looked at."""
    data = b""
    end = time.monotonic() + WAIT
    while time.monotonic() < end:
        data += port.read(0.02)
        if ascii_mode:
            if not data.endswith(b"\r\n"):
                continue
            assert data[:1] == b":" and data.count(b":") == 1, "not one frame: %r" % data
            assert data[1:-2].decode() == data[1:-2].decode().upper(), "small digits: %r" % data
            raw = bytes.fromhex(data[1:-2].decode())
            body, check = raw[:-1], raw[-1]
            assert lrc(body) == check, "wrong LRC: %r" % data
            assert len(body) in (length, 3), "length: %r" % data
            return body
        if len(data) < 5:
            continue
        want = 5 if data[1] & 0x80 else length + 2
        if len(data) >= want:
            assert len(data) == want, "more than one frame: " + data.hex(" ")
            assert crc(data[:-2]) == data[-2:], "wrong CRC: " + data.hex(" ")
            return data[:-2]
    raise AssertionError("no answer, only: " + data.hex(" "))


def ask(port, body, length):
    time.sleep(0.006)
    port.write(frame(body))
    return receive(port, length)


def silent(port, data):
    port.write(data)
    got = port.read(SILENCE)
    assert got == b"", "answered " + got.hex(" ")


def done(name):
    global checks
    checks += 1
    print("checked: " + name)


def word(value):
    return [value >> 8, value & 0xFF]


def block(station, fn, base, count):
    return [station, fn] + word(base) + word(count)


def packed(bits):
    return [sum((1 << n) for n, bit in enumerate(bits[at:at + 8]) if bit) for at in range(0, len(bits), 8)]


def read_words(port, station, fn, base, count):
    answer = ask(port, block(station, fn, base, count), 3 + 2 * count)
    assert answer[:3] == bytes([station, fn, 2 * count]), answer.hex(" ")
    return [answer[n] * 256 + answer[n + 1] for n in range(3, len(answer), 2)]


def read_bits(port, station, fn, base, count):
    size = (count + 7) // 8
    answer = ask(port, block(station, fn, base, count), 3 + size)
    assert answer[:3] == bytes([station, fn, size]), answer.hex(" ")
    assert answer[-1] >> ((count - 1) % 8 + 1) == 0, "the rest of the last byte is not 0"
    return [bool(answer[3 + n // 8] >> (n % 8) & 1) for n in range(count)]


def echoed(port, body, length=6):
    answer = ask(port, body, 6)
    assert answer == bytes(body[:length]), answer.hex(" ")


def exception(port, body, number, name):
    answer = ask(port, body, 6)
    assert answer == bytes([body[0], body[1] | 0x80, number]), answer.hex(" ")
    done("exception %d: %s" % (number, name))


def functions(port, station):
    words = [(1000 * station + 257 * n) & 0xFFFF for n in range(123)]
    body = block(station, 0x10, 100, 123) + [246] + [byte for value in words for byte in word(value)]
    echoed(port, body)
    assert read_words(port, station, 3, 100, 123) == words
    done("%d: 10 and 03 with 123 registers" % station)

    assert read_words(port, station, 3, 98, 125) == [0, 0] + words
    done("%d: 03 with 125 registers" % station)
    assert read_words(port, station, 4, 0, 125) == [0] * 125
    done("%d: 04 with 125 registers, a table of its own" % station)

    echoed(port, [station, 6] + word(65535) + word(0xABCD))
    assert read_words(port, station, 3, 65535, 1) == [0xABCD]
    done("%d: 06 and 03 of the last register" % station)

    bits = [n % 3 == 0 or n % 7 == 0 for n in range(1968)]
    data = packed(bits)
    echoed(port, block(station, 0x0F, 20, 1968) + [len(data)] + data)
    assert read_bits(port, station, 1, 20, 1968) == bits
    done("%d: 0F and 01 with 1968 coils" % station)
    assert read_bits(port, station, 1, 23, 37) == bits[3:40]
    done("%d: 01 with 37 coils from the middle of a byte" % station)
    assert read_bits(port, station, 2, 20, 2000) == [False] * 2000
    done("%d: 02 with 2000 inputs, a table of its own" % station)

    for on in (True, False):
        echoed(port, [station, 5] + word(65535) + [0xFF if on else 0, 0])
        assert read_bits(port, station, 1, 65535, 1) == [on]
    done("%d: 05 on and off" % station)


def exceptions(port, station):
    exception(port, [station, 0x2B, 0x0E, 1, 0], 1, "a function that it does not have")
    exception(port, block(station, 3, 0, 0), 3, "0 registers")
    exception(port, block(station, 3, 0, 126), 3, "126 registers")
    exception(port, block(station, 1, 0, 2001), 3, "2001 coils")
    exception(port, [station, 5, 0, 0, 0x12, 0x34], 3, "a coil that is neither FF00 nor 0000")
    exception(port, block(station, 0x10, 0, 2) + [2, 0, 0], 3, "a byte count that does not fit")
    exception(port, block(station, 4, 65530, 10), 2, "beyond the last register")
    exception(port, [station, 6] + word(505) + word(1), 3, "a protected register")
    exception(port, block(station, 0x0F, 0, 8) + [1, 0xFF], 3, "protected, one coil of eight")
    assert read_bits(port, station, 1, 0, 8) == [False] * 8
    done("nothing is written then")


def silence(port):
    good = frame(block(11, 3, 100, 1))
    if ascii_mode:
        silent(port, good[:-3] + (b"0" if good[-3:-2] != b"0" else b"1") + b"\r\n")
        silent(port, good[:-2] + b"\n")
    else:
        silent(port, good[:-1] + bytes([good[-1] ^ 1]))
    done("silence to a wrong check code")
    silent(port, frame(block(13, 3, 100, 1)))
    done("silence to a station that is not there")
    silent(port, good[:5])
    if ascii_mode:
        port.write(good)
    else:
        time.sleep(0.05)
        port.write(good)
    assert receive(port, 5)[:3] == bytes([11, 3, 2])
    done("half a query is forgotten")
    for byte in good:
        port.write(bytes([byte]))
    assert receive(port, 5)[:3] == bytes([11, 3, 2])
    done("byte by byte")


def broadcast(port):
    silent(port, frame([0, 6] + word(7) + word(4711)))
    silent(port, frame(block(0, 0x0F, 9, 3) + [1, 0x05]))
    for station in (11, 12):
        assert read_words(port, station, 3, 7, 1) == [4711]
        assert read_bits(port, station, 1, 9, 3) == [True, False, True]
    done("a broadcast is carried out by both, without an answer")
    silent(port, frame(block(0, 3, 7, 1)))
    done("a broadcast read is nobody's")


def main(where):
    port = Serial(where) if os.path.exists(where) else Tcp(where)
    for station in (11, 12):
        functions(port, station)
    exceptions(port, 11)
    silence(port)
    broadcast(port)

    # the wire's own time: 8 bytes out and 255 back, twice as many and one more in ASCII
    out, back = (17, 511) if ascii_mode else (8, 255)
    start = time.monotonic()
    read_words(port, 12, 3, 0, 125)
    spent = (time.monotonic() - start) * 1000
    least = (out + back) * 10000 / int(sys.argv[3])
    assert least <= spent < 10 * least, "%.1f of %.1f ms" % (spent, least)
    done("takes the time of the wire")
    print("ok %d" % checks)


main(sys.argv[1])
