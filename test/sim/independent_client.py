#!/usr/bin/env python3
"""An NX master written from the protocol page alone: own CRC (bit by bit), own frames, standard library only.

    independent_client.py PATH        a serial port (a pty)
    independent_client.py HOST:PORT   a serial server

Checks a simulated PLC with number 1, whose memory starts at 0. Prints one line per check, and at last "ok N".
"""

import os
import select
import socket
import sys
import termios
import time

MASTER = 0xE2
PLC = 1
WAIT = 2.0       # seconds until an answer must be there
SILENCE = 0.25   # seconds after which nobody has answered
checks = 0


def crc(data):
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = (value >> 1) ^ 0xA001 if value & 1 else value >> 1
    return bytes([value & 0xFF, value >> 8])


assert crc(b"123456789") == bytes([0x37, 0x4B])


def frame(to, sender, fn, info):
    assert 1 <= len(info) <= 256
    body = bytes([to, sender, fn, len(info) & 0xFF]) + bytes(info)
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


def receive(port, sender=PLC, to=MASTER):
    """One whole frame, its CRC checked; then the line must be silent."""
    data = b""
    end = time.monotonic() + WAIT
    while time.monotonic() < end:
        data += port.read(0.02)
        if len(data) < 4:
            continue
        length = (data[3] or 256) + 6
        if len(data) >= length:
            assert len(data) == length, "more than one frame: " + data.hex(" ")
            assert crc(data[:-2]) == data[-2:], "wrong CRC: " + data.hex(" ")
            assert (data[0], data[1]) == (to, sender), "wrong ends: " + data.hex(" ")
            return data[2], data[4:-2]
    raise AssertionError("no answer, only: " + data.hex(" "))


def silent(port, data):
    port.write(data)
    got = port.read(SILENCE)
    assert got == b"", "answered " + got.hex(" ")


def done(name):
    global checks
    checks += 1
    print("checked: " + name)


def low_high(value):
    return [value & 0xFF, value >> 8]


def rr(port):
    time.sleep(0.006)
    port.write(frame(PLC, MASTER, 0x00, [0]))
    return receive(port)


def query(port, steps, code, info):
    """Sends a query by its 4-step code; returns the INFO of R, after QA and RR where they are due."""
    fn = code if steps == 4 else code + 0x20
    port.write(frame(PLC, MASTER, fn, info))
    if steps == 4:
        assert receive(port) == (0x80, b"\0"), "no QA"
        answer, data = rr(port)
    else:
        answer, data = receive(port)
    assert answer == fn + 0x80, "function %02X" % answer
    return data


def error(port, fn, info, number):
    port.write(frame(PLC, MASTER, fn, info))
    answer, data = receive(port)
    assert answer in (0x80 | fn & 0x0F, 0x80 + fn) and data == bytes([number]), "%02X %s" % (answer, data.hex(" "))
    done("error %d to %02X" % (number, fn))


def six_functions(port, steps):
    k0, m0 = 0x0140, 0x00C0
    words = [1000 * steps + n for n in range(64)]
    payload = [byte for word in words for byte in low_high(word)]
    assert query(port, steps, 0x04, low_high(k0) + payload) == b"\0"
    assert query(port, steps, 0x03, low_high(k0) + [64]) == bytes(payload)
    done("%d-step write and read of 64 words" % steps)

    assert len(query(port, steps, 0x03, low_high(m0) + [128])) == 256
    done("%d-step read of 128 words: LEN 0 is 256" % steps)

    bits = [0xFF if n % 3 == 0 else 0x00 for n in range(40)]
    first = (k0 + 100) * 16 + 5
    assert query(port, steps, 0x02, low_high(first) + bits) == b"\0"
    assert query(port, steps, 0x01, low_high(first) + [40]) == bytes(bits)
    value = 0
    for n, bit in enumerate(bits[:11]):
        value |= (bit & 1) << (n + 5)
    assert query(port, steps, 0x03, low_high(k0 + 100) + [1]) == bytes(low_high(value))
    done("%d-step write and read of 40 bits; bits are a view on the words" % steps)

    word = 0x01BF  # K127
    bit = 0x1BFC   # K127.12
    assert query(port, steps, 0x06, low_high(word | 0x4000) + [0x78, 0x46] + low_high(bit) + [0xFF]) == b"\0"
    assert query(port, steps, 0x05, low_high(bit) + low_high(word | 0x4000)) == bytes([0xFF, 0x78, 0x56])
    done("%d-step write and read of bits and words" % steps)


def main(where):
    port = Serial(where) if os.path.exists(where) else Tcp(where)

    for steps in (2, 4):
        six_functions(port, steps)

    # RR carries the last query out again, in both modes
    query(port, 2, 0x04, low_high(0x0140) + low_high(4711))
    assert query(port, 2, 0x03, low_high(0x0140) + [1]) == bytes(low_high(4711))
    for _ in range(3):
        assert rr(port) == (0xA3, bytes(low_high(4711)))
    done("R RR R RR R after a 2-step query")

    query(port, 4, 0x03, low_high(0x0140) + [1])
    assert rr(port) == (0x83, bytes(low_high(4711)))
    done("RR again after a 4-step query")

    error(port, 0x2F, [0], 1)
    error(port, 0x0F, [0], 1)
    error(port, 0x23, [0x00, 0x90, 1], 2)
    error(port, 0x03, [0x00, 0x90, 1], 2)
    error(port, 0x23, [0xC0, 0x00], 3)
    error(port, 0x22, [0xFC, 0x1B, 0x01], 3)
    error(port, 0x24, low_high(0x01C0) + [1, 0], 4)  # F is protected here
    error(port, 0x23, [0xC0, 0x00, 200], 5)

    port.write(frame(255, MASTER, 0x23, low_high(0x0140) + [1]))
    assert receive(port) == (0xA3, bytes(low_high(4711)))
    done("255 is whichever PLC is there")

    port.write(frame(PLC, 0xC5, 0x23, low_high(0x0140) + [1]))
    assert receive(port, to=0xC5) == (0xA3, bytes(low_high(4711)))
    done("the answer goes back to the ID that asked")

    good = frame(PLC, MASTER, 0x23, low_high(0x0140) + [1])
    silent(port, good[:-1] + bytes([good[-1] ^ 1]))
    done("silence to a wrong CRC")
    silent(port, frame(2, MASTER, 0x23, low_high(0x0140) + [1]))
    done("silence to another station's query")
    silent(port, good[:5])
    port.write(good)
    assert receive(port) == (0xA3, bytes(low_high(4711)))
    done("half a frame is forgotten")
    for byte in good:
        port.write(bytes([byte]))
    assert receive(port) == (0xA3, bytes(low_high(4711)))
    done("byte by byte")

    # the wire's own time: 9 bytes out, 262 back at 38400 bit/s = 70.6 ms
    start = time.monotonic()
    assert len(query(port, 2, 0x03, low_high(0x00C0) + [128])) == 256
    spent = (time.monotonic() - start) * 1000
    assert 70 <= spent < 700, "%.1f ms" % spent
    done("takes the time of the wire")
    print("ok %d" % checks)


main(sys.argv[1])
