"""Frames made by pymodbus, as JSON lines: what is asked, the request and the answer in RTU and in ASCII, and what the answer means.

    python pymodbus_frames.py COUNT SEED
"""

import json
import random
import sys

from pymodbus.framer import FramerAscii, FramerRTU
from pymodbus.pdu import DecodePDU, ExceptionResponse
from pymodbus.pdu import bit_message as bits
from pymodbus.pdu import register_message as words

CODES = [1, 2, 3, 4, 5, 6, 7, 8, 10, 11]
EDGES = [0, 1, 7, 8, 9, 15, 16, 17, 100, 1000]


class Maker:
    def __init__(self, seed):
        self.random = random.Random(seed)
        self.rtu = FramerRTU(DecodePDU(False))
        self.ascii = FramerAscii(DecodePDU(False))

    def count(self, most):
        """Often small, often the most, sometimes anything."""
        kind = self.random.random()
        if kind < 0.1:
            return most
        return self.random.randint(1, min(most, 20)) if kind < 0.7 else self.random.randint(1, most)

    def word(self):
        return self.random.choice([0, 1, 0xFF, 0x0D0A, 0x3A3A, 0xFFFF, self.random.randint(0, 0xFFFF)])

    def query(self, function):
        random_ = self.random
        most = {1: 2000, 2: 2000, 3: 125, 4: 125, 5: 1, 6: 1, 15: 1968, 16: 123}[function]
        count = self.count(most)
        base = random_.choice([random_.choice(EDGES), random_.randint(0, 65536 - count), 65536 - count])
        asked = {"fn": function, "base": base}
        if function <= 4:
            return {**asked, "count": count}
        if function == 5:
            return {**asked, "value": random_.random() < 0.5}
        if function == 6:
            return {**asked, "value": self.word()}
        return {**asked, "values": [random_.random() < 0.5 if function == 15 else self.word() for _ in range(count)]}

    def request(self, query, station):
        at = {"address": query["base"], "dev_id": station}
        function = query["fn"]
        if function <= 4:
            kinds = {
                1: bits.ReadCoilsRequest,
                2: bits.ReadDiscreteInputsRequest,
                3: words.ReadHoldingRegistersRequest,
                4: words.ReadInputRegistersRequest,
            }
            return kinds[function](count=query["count"], **at)
        if function == 5:
            return bits.WriteSingleCoilRequest(bits=[query["value"]], **at)
        if function == 6:
            return words.WriteSingleRegisterRequest(registers=[query["value"]], **at)
        if function == 15:
            return bits.WriteMultipleCoilsRequest(bits=query["values"], **at)
        return words.WriteMultipleRegistersRequest(registers=query["values"], **at)

    def answer(self, query, station):
        """The answer, and what it means: values, true for a write, or the number of an exception."""
        function = query["fn"]
        if self.random.random() < 0.15:
            code = self.random.choice(CODES)
            return ExceptionResponse(function, code, device_id=station), {"exception": code}
        at = {"address": query["base"], "dev_id": station}
        if function in (1, 2):
            values = [self.random.random() < 0.5 for _ in range(query["count"])]
            kind = bits.ReadCoilsResponse if function == 1 else bits.ReadDiscreteInputsResponse
            return kind(bits=values, dev_id=station), {"values": values}
        if function in (3, 4):
            values = [self.word() for _ in range(query["count"])]
            kind = words.ReadHoldingRegistersResponse if function == 3 else words.ReadInputRegistersResponse
            return kind(registers=values, dev_id=station), {"values": values}
        if function == 5:
            return bits.WriteSingleCoilResponse(bits=[query["value"]], **at), {"values": True}
        if function == 6:
            return words.WriteSingleRegisterResponse(registers=[query["value"]], **at), {"values": True}
        kind = bits.WriteMultipleCoilsResponse if function == 15 else words.WriteMultipleRegistersResponse
        return kind(count=len(query["values"]), **at), {"values": True}

    def pair(self, function):
        station = self.random.randint(1, 247)
        query = self.query(function)
        request = self.request(query, station)
        answer, means = self.answer(query, station)
        frames = {
            mode: {"request": framer.buildFrame(request).hex(), "answer": framer.buildFrame(answer).hex()}
            for mode, framer in (("rtu", self.rtu), ("ascii", self.ascii))
        }
        return {"station": station, "query": query, **frames, **means}


def main():
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    maker = Maker(seed)
    functions = [1, 2, 3, 4, 5, 6, 15, 16]
    for n in range(count):
        sys.stdout.write(json.dumps(maker.pair(functions[n % len(functions)])) + "\n")


main()
