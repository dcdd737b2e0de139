-- Takes MOVILINK apart in Wireshark: on SBus (Decode As, table can.subdissector), on RS-485 (link type USER0)
-- and PROFIBUS frames (link type USER1) as `ipos run --log x.pcapng` writes them. Written by `ipos bus
-- dissector`, which puts the tables of this project in front of this text.
local text_of_service, text_of_class = {}, {}
for code, text in pairs(services) do text_of_service[code] = text end
for class, text in pairs(classes) do text_of_class[class] = text end

local movilink = Proto("movilink", "SEW MOVILINK")
local f = movilink.fields
f.telegram = ProtoField.string("movilink.telegram", "Telegram")
f.address = ProtoField.uint8("movilink.address", "Address")
f.group = ProtoField.uint8("movilink.group", "Group")
f.station = ProtoField.string("movilink.station", "Station")
f.response = ProtoField.bool("movilink.response", "Response")
f.type = ProtoField.uint8("movilink.type", "Type")
f.management = ProtoField.uint8("movilink.management", "Management", base.HEX)
f.service = ProtoField.uint8("movilink.service", "Service", base.DEC, text_of_service, 0x0F)
f.length = ProtoField.uint8("movilink.length", "Data length - 1", base.DEC, nil, 0x30)
f.handshake = ProtoField.bool("movilink.handshake", "Handshake", 8, nil, 0x40)
f.failed = ProtoField.bool("movilink.failed", "Failed", 8, nil, 0x80)
f.subindex = ProtoField.uint8("movilink.subindex", "Subindex")
f.index = ProtoField.uint16("movilink.index", "Index")
f.index_name = ProtoField.string("movilink.index_name", "Index name")
f.value = ProtoField.int32("movilink.value", "Value")
f.error_class = ProtoField.uint8("movilink.error_class", "Error class", base.DEC, text_of_class)
f.error_code = ProtoField.uint8("movilink.error_code", "Error code")
f.error_additional = ProtoField.uint16("movilink.error_additional", "Additional code", base.HEX)
f.error = ProtoField.string("movilink.error", "Error")
f.po = ProtoField.uint16("movilink.po", "PO", base.HEX)
f.pi = ProtoField.uint16("movilink.pi", "PI", base.HEX)
f.word = ProtoField.string("movilink.word", "Process data")
f.variable = ProtoField.string("movilink.variable", "Variable")
f.check = ProtoField.uint8("movilink.bcc", "Block check", base.HEX)
f.void = ProtoField.string("movilink.void", "Void")

local can_id = Field.new("can.id")
local can_extended = Field.new("can.flags.xtd")
local can_remote = Field.new("can.flags.rtr")

-- Fields that say what others mean are in brackets.
local function explain(tree, field, text)
  if text ~= nil and text ~= "" then tree:add(field, text):set_generated() end
end

local function unit_at(address)
  return units[address] or {}
end

local function index_name(unit, index)
  local variables = unit.variable_names or {}
  if index >= 11000 and index < 11000 + (unit.variables or default_variables) then
    return variables[index - 11000] or ("H" .. (index - 11000))
  end
  local list = parameters[unit.type or default_type]
  return list[index] or "unknown index"
end

-- The eight bytes of the parameter channel; gives the words for the list of packets.
local function parameter(buffer, tree, unit, request)
  local management = buffer(0, 1)
  tree:add(f.management, management)
  tree:add(f.service, management)
  tree:add(f.length, management)
  tree:add(f.handshake, management)
  tree:add(f.failed, management)
  tree:add(f.subindex, buffer(1, 1))
  tree:add(f.index, buffer(2, 2))
  local index = buffer(2, 2):uint()
  local name = index_name(unit, index)
  explain(tree, f.index_name, name)
  local code = management:uint() % 16
  local words = string.format("%s %d %s", services[code] or ("service " .. code), index, name)
  if not request and management:uint() >= 0x80 then
    tree:add(f.error_class, buffer(4, 1))
    tree:add(f.error_code, buffer(5, 1))
    tree:add(f.error_additional, buffer(6, 2))
    local text = errors[buffer(4, 4):uint()] or classes[buffer(4, 1):uint()] or "unknown"
    explain(tree, f.error, text)
    return words .. " refused: " .. text
  end
  tree:add(f.value, buffer(4, 4))
  local writes = code == 2 or code == 3
  if writes == request and code ~= 0 then words = words .. " = " .. buffer(4, 4):int() end
  return words
end

-- A number by its assignment: "SPEED 1000.0 rpm".
local function word_text(input, code, word)
  local names = input and pi_names or po_names
  local name = code and code ~= 0 and names[code]
  if not name then return nil end
  local scale = (input and pi_scales or po_scales)[code]
  if not scale or scale.denominator == 0 then return string.format("%s %04Xh", name, word) end
  local value = word
  if scale.signed and word >= 0x8000 then value = word - 0x10000 end
  return string.format("%s %g %s", name, value * scale.numerator / scale.denominator, scale.unit)
end

local function process(buffer, tree, unit, input, count)
  local words = {}
  for n = 0, count - 1 do
    local part = buffer(2 * n, 2)
    local item = tree:add(input and f.pi or f.po, part)
    local code = (input and unit.pi or unit.po or {})[n + 1]
    local text = word_text(input, code, part:uint())
    if text then
      item:append_text(" (" .. text .. ")")
      explain(tree, f.word, text)
    end
    words[#words + 1] = text or string.format("%04Xh", part:uint())
  end
  return (input and "PI " or "PO ") .. table.concat(words, ", ")
end

local function variables(object, buffer, tree)
  local words = {}
  for _, part in ipairs(object.parts) do
    if buffer:len() >= part.offset + part.size then
      local bytes = buffer(part.offset, part.size)
      local value
      if part.size < 4 then
        value = object.little and bytes:le_uint() or bytes:uint()
      else
        value = object.little and bytes:le_int() or bytes:int()
      end
      words[#words + 1] = part.name .. " = " .. value
      tree:add(f.variable, bytes, words[#words])
    end
  end
  return table.concat(words, ", ")
end

function movilink.dissector(buffer, pinfo, root)
  local id = can_id()
  if id == nil then return 0 end
  if can_extended() and can_extended()() then return 0 end
  if can_remote() and can_remote()() then return 0 end
  id = id()
  local object = objects[id]
  local telegram = id < 1024 and telegrams[(id >= 512 and 8 or 0) + id % 8] or nil
  if not object and not telegram then return 0 end
  local tree = root:add(movilink, buffer())
  pinfo.cols.protocol = "MOVILINK"
  if object then
    explain(tree, f.station, object.station)
    pinfo.cols.info = object.station .. ": " .. variables(object, buffer, tree)
    return buffer:len()
  end
  local address = math.floor(id % 512 / 8)
  if buffer:len() ~= (telegram.parameter and 8 or 6) then
    tree:append_text(", wrong length")
    return buffer:len()
  end
  explain(tree, f.telegram, telegram.text)
  tree:add(telegram.grouped and f.group or f.address, address):set_generated()
  local unit = telegram.grouped and (groups[address] or {}) or unit_at(address)
  explain(tree, f.station, unit.name)
  local words
  if telegram.parameter then
    words = parameter(buffer, tree, unit, telegram.from_master)
  else
    words = process(buffer, tree, unit, not telegram.from_master, 3)
  end
  local whom = telegram.grouped and ("group " .. address) or unit.name or ("address " .. address)
  pinfo.cols.info = words .. (telegram.from_master and " -> " or " <- ") .. whom
  tree:append_text(", " .. words)
  return buffer:len()
end
DissectorTable.get("can.subdissector"):add_for_decode_as(movilink)

-- RS-485: SD, ADR, TYP, PDU, BCC.
local serial = Proto("movilink_serial", "SEW MOVILINK on RS-485")
local function void(tree, pinfo, reason)
  explain(tree, f.void, reason)
  pinfo.cols.info = "void: " .. reason
end

function serial.dissector(buffer, pinfo, root)
  local tree = root:add(movilink, buffer())
  pinfo.cols.protocol = "MOVILINK"
  local size = buffer:len()
  if size < 4 then return void(tree, pinfo, "too short") end
  local start, kind = buffer(0, 1):uint(), buffer(2, 1):uint()
  if start ~= 0x02 and start ~= 0x1D then return void(tree, pinfo, "no start delimiter") end
  local base_kind = kind % 128
  if base_kind > 6 then return void(tree, pinfo, "unknown type") end
  local has_parameter = base_kind % 2 == 0
  local count = base_kind == 6 and 0 or math.floor(base_kind / 2) + 1
  if size ~= 4 + (has_parameter and 8 or 0) + 2 * count then return void(tree, pinfo, "wrong length") end
  local check = 0
  for n = 0, size - 2 do check = bit.bxor(check, buffer(n, 1):uint()) end
  if check ~= buffer(size - 1, 1):uint() then return void(tree, pinfo, "block check") end
  local response = start == 0x1D
  local address = buffer(1, 1):uint()
  local unit = serial_units[address] or {}
  tree:add(f.response, response):set_generated()
  tree:add(f.address, buffer(1, 1))
  explain(tree, f.station, unit.name)
  tree:add(f.type, buffer(2, 1))
  local words, at = {}, 3
  if has_parameter then
    words[1] = parameter(buffer(at, 8):tvb(), tree, unit, not response)
    at = at + 8
  end
  if count > 0 then
    words[#words + 1] = process(buffer(at, 2 * count):tvb(), tree, unit, response, count)
    at = at + 2 * count
  end
  tree:add(f.check, buffer(at, 1))
  pinfo.cols.info = table.concat(words, ", ") .. (response and " <- " or " -> ") .. (unit.name or ("address " .. address))
end
DissectorTable.get("wtap_encap"):add(wtap.USER0, serial)

-- PROFIBUS: the formats SD1 to SD4 and SC of the data link.
local fdl = Proto("ipos_fdl", "PROFIBUS data link")
local d = fdl.fields
d.destination = ProtoField.uint8("ipos_fdl.destination", "Destination")
d.source = ProtoField.uint8("ipos_fdl.source", "Source")
d.control = ProtoField.uint8("ipos_fdl.control", "Frame control", base.HEX)
d.dsap = ProtoField.uint8("ipos_fdl.dsap", "DSAP")
d.ssap = ProtoField.uint8("ipos_fdl.ssap", "SSAP")
d.data = ProtoField.bytes("ipos_fdl.data", "Data")
d.fms = ProtoField.string("ipos_fdl.fms", "FMS")
d.void = ProtoField.string("ipos_fdl.void", "Void")

-- FMS on access points 20 to 26: an octet of the LLI, then a unit of components (docs/reference/protocols/profibus.md#fms).
local links = {[0] = "data", "Associate", "Associated", "Refused", "Abort", "idle"}
local kinds = {"request", "response", "error", nil, "Reject", "Initiate"}
local services = {[0] = "Status", "Identify", "Read", "Write", "Get-OV", [25] = "Acknowledge-Event-Notification",
                  [26] = "Phys.-Read", [27] = "Phys.-Write"}

-- The ID Info at a place: tag, length and the place behind it; nothing where the octets end before.
local function id_info(buffer, at)
  if at >= buffer:len() then return end
  local head = buffer(at, 1):uint()
  local tag, length = math.floor(head / 16) % 8, head % 16
  at = at + 1
  if tag == 7 then
    if at >= buffer:len() then return end
    tag, at = buffer(at, 1):uint(), at + 1
  end
  if length == 15 then
    if at >= buffer:len() then return end
    length, at = buffer(at, 1):uint(), at + 1
  end
  return tag, length, at
end

local function fms_words(buffer)
  local link = buffer(0, 1):uint()
  local text = links[link] or "no unit of FMS"
  local tag, _, at = id_info(buffer, link == 1 and 3 or 1)
  if link > 3 or not tag or not kinds[tag] then return text end
  if tag == 6 then return text .. ", " .. kinds[tag] end
  if at >= buffer:len() then return "no unit of FMS" end
  local invoke = buffer(at, 1):uint()
  if tag == 5 then return string.format("Reject of request %d", invoke) end
  local service, parts, place = id_info(buffer, at + 1)
  if not service then return "no unit of FMS" end
  text = string.format("%s %s %d", services[service] or ("service " .. service), kinds[tag], invoke)
  for _ = 1, parts do
    local part, length, from = id_info(buffer, place)
    if not part or from + length > buffer:len() then return text end
    if tag == 1 and part == 0 and length == 2 then
      text = string.format("%s, index %d", text, buffer(from, 2):uint())
    elseif length > 0 then
      text = text .. ": " .. tostring(buffer(from, length):bytes())
    end
    place = from + length
  end
  return text
end

local function addresses(buffer, tree, at)
  tree:add(d.destination, buffer(at, 1), buffer(at, 1):uint() % 128)
  tree:add(d.source, buffer(at + 1, 1), buffer(at + 1, 1):uint() % 128)
end

function fdl.dissector(buffer, pinfo, root)
  local tree = root:add(fdl, buffer())
  pinfo.cols.protocol = "PROFIBUS"
  local size, start = buffer:len(), buffer(0, 1):uint()
  if start == 0xE5 and size == 1 then
    pinfo.cols.info = "short acknowledgement"
    return
  elseif start == 0xDC and size == 3 then
    addresses(buffer, tree, 1)
    pinfo.cols.info = string.format("token %d -> %d", buffer(2, 1):uint() % 128, buffer(1, 1):uint() % 128)
    return
  end
  local first, last
  if start == 0x10 and size == 6 then
    first, last = 1, size - 2
  elseif start == 0xA2 and size == 14 then
    first, last = 1, size - 2
  elseif start == 0x68 and size >= 9 and buffer(1, 1):uint() == size - 6 then
    first, last = 4, size - 2
  end
  if not first or buffer(size - 1, 1):uint() ~= 0x16 then
    explain(tree, d.void, "no frame of the data link")
    return
  end
  local sum = 0
  for n = first, last - 1 do sum = (sum + buffer(n, 1):uint()) % 256 end
  if sum ~= buffer(last, 1):uint() then
    explain(tree, d.void, "frame check")
    return
  end
  addresses(buffer, tree, first)
  tree:add(d.control, buffer(first + 2, 1))
  local at, dsap, ssap = first + 3
  if buffer(first, 1):uint() >= 128 and at < last then
    dsap = buffer(at, 1):uint() % 64
    tree:add(d.dsap, buffer(at, 1), dsap)
    at = at + 1
  end
  if buffer(first + 1, 1):uint() >= 128 and at < last then
    ssap = buffer(at, 1):uint() % 64
    tree:add(d.ssap, buffer(at, 1), ssap)
    at = at + 1
  end
  local words = ""
  -- The access point of the slave: where a request goes, and where an answer comes from.
  local point = math.floor(buffer(first + 2, 1):uint() / 64) % 2 == 1 and dsap or ssap
  if at < last then
    tree:add(d.data, buffer(at, last - at))
    if point and point >= 20 and point <= 26 then
      words = fms_words(buffer(at, last - at):tvb())
      tree:add(d.fms, buffer(at, last - at), words)
      words = string.format(", FMS connection %d: %s", point - 18, words)
    end
  end
  pinfo.cols.info = string.format("%d -> %d, control %02X%s", buffer(first + 1, 1):uint() % 128,
                                  buffer(first, 1):uint() % 128, buffer(first + 2, 1):uint(), words)
end
DissectorTable.get("wtap_encap"):add(wtap.USER1, fdl)
