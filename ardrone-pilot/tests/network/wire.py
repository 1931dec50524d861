#!/usr/bin/env python3
"""A slow and lossy wire between two network namespaces, each of which gets a device `wire`: wire.py ONE OTHER.

A line `MILLISECONDS LOSS` on standard input (as `50 0.1`) says how long each packet takes, and which part of them is lost.
It ends with standard input. The kernel could do so by itself (netem), where it is built with that.
"""

import ctypes
import fcntl
import heapq
import os
import random
import selectors
import struct
import sys
import time

TUNSETIFF = 0x400454CA
IFF_TUN, IFF_NO_PI = 0x0001, 0x1000


def device(namespace):
    """A device `wire` in a namespace; what is sent to it can be read from the file, and the other way round."""
    with open(f"/run/netns/{namespace}", "rb") as there:
        if ctypes.CDLL(None, use_errno=True).setns(there.fileno(), 0) != 0:
            raise OSError(ctypes.get_errno(), "setns")
    tun = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(tun, TUNSETIFF, struct.pack("16sH22x", b"wire", IFF_TUN | IFF_NO_PI))
    return tun


def main():
    one, other = (device(namespace) for namespace in sys.argv[1:3])
    ends = {one: other, other: one}
    delay_s, loss = 0.0, 0.0
    draw = random.Random(1)
    under_way = []  # (when it arrives, number, where, packet)
    number = 0
    selector = selectors.DefaultSelector()
    for file in (one, other, sys.stdin.fileno()):
        selector.register(file, selectors.EVENT_READ)
    print("ready", flush=True)
    while True:
        wait = max(0.0, under_way[0][0] - time.monotonic()) if under_way else None
        for key, _ in selector.select(wait):
            if key.fd not in ends:
                words = os.read(key.fd, 4096).decode().split()
                if not words:
                    return
                delay_s, loss = float(words[-2]) / 1000, float(words[-1])
                continue
            packet = os.read(key.fd, 65536)
            if draw.random() >= loss:
                number += 1
                heapq.heappush(under_way, (time.monotonic() + delay_s, number, ends[key.fd], packet))
        while under_way and under_way[0][0] <= time.monotonic():
            _, _, to, packet = heapq.heappop(under_way)
            try:
                os.write(to, packet)
            except OSError:
                pass  # The device is not up yet, or full: lost.


main()
