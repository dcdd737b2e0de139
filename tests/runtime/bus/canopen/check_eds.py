"""Reads an EDS as a configuration tool does (CiA 306): sections, counts, data types and limits.

Prints the number of objects and entries; a fault ends the program with its text.
"""
import configparser
import sys

SIZES = {0x02: 8, 0x03: 16, 0x04: 32, 0x05: 8, 0x06: 16, 0x07: 32}
SIGNED = {0x02, 0x03, 0x04}
VISIBLE_STRING = 0x09


def number(text, node=5):
    text = text.upper()
    if text.startswith("$NODEID+"):
        return node + int(text[8:], 0)
    return int(text, 0)


def check_entry(eds, section):
    entry = eds[section]
    assert entry["ParameterName"] and len(entry["ParameterName"]) <= 241, section
    assert number(entry["ObjectType"]) == 7, section
    data_type = number(entry["DataType"])
    assert entry["AccessType"] in ("ro", "wo", "rw", "rwr", "rww", "const"), section
    assert entry["PDOMapping"] in ("0", "1"), section
    if data_type == VISIBLE_STRING:
        return
    bits = SIZES[data_type]
    low, high = (-(1 << bits - 1), (1 << bits - 1) - 1) if data_type in SIGNED else (0, (1 << bits) - 1)
    for key in ("DefaultValue", "LowLimit", "HighLimit"):
        if key in entry:
            assert low <= number(entry[key]) <= high, (section, key, entry[key])
    if "LowLimit" in entry and "HighLimit" in entry:
        assert number(entry["LowLimit"]) <= number(entry["HighLimit"]), section


def main(path):
    with open(path, encoding="ascii") as file:
        text = file.read()
    eds = configparser.ConfigParser(interpolation=None, strict=True)
    eds.optionxform = str
    eds.read_string(text)
    for section, keys in {
        "FileInfo": ("FileName", "FileVersion", "FileRevision", "EDSVersion", "Description", "CreationTime",
                     "CreationDate", "CreatedBy", "ModificationTime", "ModificationDate", "ModifiedBy"),
        "DeviceInfo": ("VendorName", "VendorNumber", "ProductName", "ProductNumber", "RevisionNumber", "OrderCode",
                       "BaudRate_10", "BaudRate_20", "BaudRate_50", "BaudRate_125", "BaudRate_250", "BaudRate_500",
                       "BaudRate_800", "BaudRate_1000", "SimpleBootUpMaster", "SimpleBootUpSlave", "Granularity",
                       "DynamicChannelsSupported", "GroupMessaging", "NrOfRXPDO", "NrOfTXPDO", "LSS_Supported"),
        "DummyUsage": tuple(f"Dummy{n:04d}" for n in range(1, 8)),
    }.items():
        for key in keys:
            assert key in eds[section], (section, key)

    lists = {}
    for section in ("MandatoryObjects", "OptionalObjects", "ManufacturerObjects"):
        count = int(eds[section]["SupportedObjects"])
        assert len(eds[section]) == count + 1, section
        lists[section] = [number(eds[section][str(n)]) for n in range(1, count + 1)]
    assert lists["MandatoryObjects"] == [0x1000, 0x1001, 0x1018]
    assert all(0x1000 <= n < 0x2000 or n >= 0x6000 for n in lists["OptionalObjects"])
    assert all(0x2000 <= n < 0x6000 for n in lists["ManufacturerObjects"])
    objects = sum(lists.values(), [])
    assert len(set(objects)) == len(objects)

    expected = {"FileInfo", "DeviceInfo", "DummyUsage", "Comments", *lists}
    entries = 0
    for index in objects:
        section = f"{index:04X}"
        expected.add(section)
        kind = number(eds[section]["ObjectType"])
        assert kind in (7, 8, 9), section
        if kind == 7:
            check_entry(eds, section)
            entries += 1
            continue
        subs = [name for name in eds.sections() if name.startswith(section + "sub")]
        assert len(subs) == int(eds[section]["SubNumber"]), section
        # Sub-index 0 is the highest one, or the number of those in use.
        assert number(eds[section + "sub0"]["DataType"]) == 5, section
        highest = max(int(name[7:], 16) for name in subs)
        if eds[section + "sub0"]["AccessType"] == "const":
            assert number(eds[section + "sub0"]["DefaultValue"]) == highest, section
        for name in subs:
            check_entry(eds, name)
            expected.add(name)
            entries += 1
    assert set(eds.sections()) == expected, set(eds.sections()) ^ expected
    pdos = [sum(f"{base + n:04X}" in eds for n in range(512)) for base in (0x1400, 0x1600, 0x1800, 0x1A00)]
    assert pdos == [int(eds["DeviceInfo"]["NrOfRXPDO"])] * 2 + [int(eds["DeviceInfo"]["NrOfTXPDO"])] * 2, pdos
    print(len(objects), entries)


main(sys.argv[1])
