"""serial_peer.py PATH: opens a serial line with python3-serial, as a program that speaks MOVILINK would (9600 baud, 8E1),
and expects every byte back with all bits inverted."""
import sys

import serial

from checks import check

line = serial.Serial(sys.argv[1], baudrate=9600, bytesize=8, parity=serial.PARITY_EVEN, stopbits=1, timeout=2)
every_byte = bytes(range(256))
line.write(every_byte)
check("every byte", line.read(256), bytes(255 - b for b in every_byte))
line.timeout = 1.9  # sets all parameters again
for size in (1, 10, 300):
    line.write(b"\x02" * size)
    check(f"{size} bytes", line.read(size), b"\xfd" * size)
line.close()

line.timeout = 0.1
line.open()
check("nothing is left over", line.read(1), b"")
line.close()
print("end")
