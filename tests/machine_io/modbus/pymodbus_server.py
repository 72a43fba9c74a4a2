#!/usr/bin/python3
"""A Modbus server by pymodbus: registers that the test knows, in every type and word order.

    pymodbus_server.py tcp            binds a free port of 127.0.0.1 and prints "port N"
    pymodbus_server.py rtu DEVICE     serves the serial line and prints "ready"

Holding and input register 0 on: 123.456, -7.25, 0.001 as float32 abcd, cdab, badc, dcba (24 words);
then the same as int32 of micrometres abcd, cdab (12 words), float64 abcd, dcba of 123.456 (8 words),
int16 -1234, uint16 54321, tool 7, line 321.
"""
import asyncio
import struct
import sys

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext

POSITIONS = (123.456, -7.25, 0.001)


def words_of(data, order):
    words = [data[i:i + 2] for i in range(0, len(data), 2)]
    if order in ("cdab", "dcba"):
        words.reverse()
    if order in ("badc", "dcba"):
        words = [word[::-1] for word in words]
    return [struct.unpack(">H", word)[0] for word in words]


def registers():
    out = []
    for order in ("abcd", "cdab", "badc", "dcba"):
        for value in POSITIONS:
            out += words_of(struct.pack(">f", value), order)
    for order in ("abcd", "cdab"):
        for value in POSITIONS:
            out += words_of(struct.pack(">i", round(value * 1000)), order)
    for order in ("abcd", "dcba"):
        out += words_of(struct.pack(">d", POSITIONS[0]), order)
    return out + [struct.unpack(">H", struct.pack(">h", -1234))[0], 54321, 7, 321]


def context():
    # zero_mode: without it every address is one off.
    slave = ModbusSlaveContext(
        hr=ModbusSequentialDataBlock(0, registers()),
        ir=ModbusSequentialDataBlock(0, registers()), zero_mode=True)
    return ModbusServerContext(slaves={1: slave}, single=False)


async def serve_tcp():
    from pymodbus.server.async_io import ModbusTcpServer
    server = ModbusTcpServer(context(), address=("127.0.0.1", 0))
    task = asyncio.ensure_future(server.serve_forever())
    await server.serving
    print("port", server.server.sockets[0].getsockname()[1], flush=True)
    await task


async def serve_rtu(device):
    from pymodbus.server.async_io import ModbusSerialServer
    from pymodbus.transaction import ModbusRtuFramer
    server = ModbusSerialServer(context(), framer=ModbusRtuFramer, port=device, baudrate=115200)
    await server.start()
    print("ready", flush=True)
    await server.serve_forever()


if __name__ == "__main__":
    asyncio.run(serve_tcp() if sys.argv[1] == "tcp" else serve_rtu(sys.argv[2]))
