"""Compares the dialect's generated code with pymavlink 2.4.50: cargo xtask mavlink --table | python crc_extra.py [TABLE]

For each message: number, name, CRC_EXTRA, fields with types, lengths and order on the wire, extension fields, length.
The exit status is 1 if anything differs. pymavlink is asked twice:
- its generator reads our pilot.xml and must get the same as ours, for every message;
- its own dialect must agree. It has no definition of the messages in ABSENT. Extension fields are appended to a message
  as MAVLink grows; those that are newer than pymavlink are behind what both know. They are listed.
"""

import sys
from pathlib import Path

import pymavlink
from pymavlink.dialects.v20 import all as dialect
from pymavlink.generator import mavparse

XML = Path(__file__).resolve().parents[3] / "mavlink-vehicle/dialect/pilot.xml"
WIRE = {
    "char": "u8", "uint8_t": "u8", "int8_t": "i8", "uint16_t": "u16", "int16_t": "i16", "uint32_t": "u32",
    "int32_t": "i32", "uint64_t": "u64", "int64_t": "i64", "float": "f32", "double": "f64",
}
MESSAGES = 71
ABSENT = {"COMMAND_CANCEL", "PROTOCOL_VERSION", "COMPONENT_METADATA", "EVENT", "CURRENT_EVENT_SEQUENCE"}


def field(name, kind, length):
    return f"{name}:{WIRE[kind]}[{length}]" if length else f"{name}:{WIRE[kind]}"


def size(fields):
    """Bytes of these fields."""
    total = 0
    for text in fields:
        kind, _, length = text.split(":")[1].rstrip("]").partition("[")
        total += int(kind[1:]) // 8 * int(length or 1)
    return total


def generated():
    """What pymavlink's generator makes of our XML: (name, CRC_EXTRA, length, base fields, extension fields)."""
    found = {}
    for message in mavparse.MAVXML(str(XML), wire_protocol_version="2.0").message:
        fields = [field(f.name, f.type, f.array_length) for f in message.ordered_fields]
        start = message.extensions_start
        start = len(fields) if start is None else start
        found[message.id] = message.name, message.crc_extra, message.wire_length, fields[:start], fields[start:]
    return found


def shipped():
    """What pymavlink's own dialect has: (name, CRC_EXTRA, length, all fields)."""
    found = {}
    for number, message in dialect.mavlink_map.items():
        kinds = dict(zip(message.fieldnames, message.fieldtypes))
        # The lengths are in the order of the wire already.
        lengths = zip(message.ordered_fieldnames, message.array_lengths)
        fields = [field(name, kinds[name], length) for name, length in lengths]
        found[number] = message.msgname, message.crc_extra, message.unpacker.size, fields
    return found


def main():
    text = open(sys.argv[1]) if len(sys.argv) > 1 else sys.stdin
    with text:
        rows = [line.rstrip("\n").split("\t") for line in text if "\t" in line]
    from_xml, own = generated(), shipped()
    different, newer, agree, agree_with_xml = [], [], 0, 0
    for number, name, crc_extra, length, base, extensions in rows:
        number, base, extensions = int(number), base.split(), extensions.split()
        ours = name, int(crc_extra), int(length), base, extensions
        if from_xml.get(number) == ours:
            agree_with_xml += 1
        else:
            different.append(f"from the XML: {ours}, not {from_xml.get(number)}")
        if name in ABSENT:
            continue
        theirs = own.get(number)
        if theirs is None:
            different.append(f"pymavlink has no {name} {number}")
            continue
        fields = theirs[3]
        new = (base + extensions)[len(fields):]
        same = (name, int(crc_extra), int(length) - size(new), (base + extensions)[: len(fields)]) == theirs
        if same and len(new) <= len(extensions):
            agree += 1
            if new:
                newer.append(f"{name} {' '.join(new)}")
        else:
            different.append(f"{ours}, not {theirs}")
    if len(rows) != MESSAGES or len({row[0] for row in rows}) != MESSAGES or len(from_xml) != MESSAGES:
        different.append(f"{len(rows)} messages in the table and {len(from_xml)} in the XML, not {MESSAGES}")
    for line in newer:
        print(f"newer than pymavlink: {line}")
    for line in different:
        print(f"differs: {line}")
    version = pymavlink.__version__
    print(f"{agree_with_xml} of {MESSAGES} messages are as pymavlink {version} generates them; "
          f"{agree} of the {MESSAGES - len(ABSENT)} of its own dialect agree")
    return 1 if different else 0


sys.exit(main())
