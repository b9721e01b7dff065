"""Reads of holding registers by pymodbus, for the bench.

    python pymodbus_client.py '{"link": "/dev/pts/3", "baudRate": 9600, "station": 11, "count": 10}'

Prints one line of JSON when the port is open; then, for each number on stdin, reads so many times and prints one with the milliseconds of
processor and of time that one read took.
"""

import json
import sys
import time

from pymodbus.client import ModbusSerialClient


def main():
    place = json.loads(sys.argv[1])
    client = ModbusSerialClient(place["link"], baudrate=place["baudRate"], timeout=2, retries=0)
    if not client.connect():
        sys.exit("the port was not opened")
    print("{}", flush=True)
    for line in sys.stdin:
        requests = int(line)
        cpu, start = time.process_time(), time.monotonic()
        for _ in range(requests):
            answer = client.read_holding_registers(0, count=place["count"], device_id=place["station"])
            if answer.isError() or len(answer.registers) != place["count"]:
                sys.exit("the answer has no values")
        times = {"cpu": time.process_time() - cpu, "cycle": time.monotonic() - start}
        print(json.dumps({name: 1000 * seconds / requests for name, seconds in times.items()}), flush=True)
    client.close()


main()
