-- Words are numbers from 0 to 2^32 - 1 here, so that >> is a shift of 32 bits; `high` brings the sign of IPOS's >>.
local accepted, foreign, wrong, result, actual, written = 0, 0, 0, 0, {}, {}
local function sum_up(first, second)
  local check = 0
  for octet = 0, 24, 8 do check = check + ((first >> octet) & 0xFF) end
  for octet = 0, 16, 8 do check = check ~ ((second >> octet) & 0xFF) end
  return (check ~ (check >> 4)) & 0xF
end
local function serve(first, second)
  if first & 0xFF ~= 0x68 then wrong = wrong + 1 return end
  local address = (first >> 8) & 0x3
  if address == 3 then foreign = foreign + 1 return end
  local service = (first >> 10) & 3
  local index = (first >> 12) & 0x3F
  local value = (first >> 18) & 0x3FF
  if value & 0x200 ~= 0 then value = value | ~0x3FF end
  local ramp = second & 0xFFF
  if sum_up(first, second) & 0x3 == (second >> 24) & 0x3 then
    accepted = accepted + 1
    if service == 0 then result = result * 3 + actual[index]
    elseif service == 1 then actual[index] = actual[index] + value
    elseif service == 2 then
      actual[index] = value ~ ramp
      written[index] = written[index] + 1
    elseif second & 0x1000 ~= 0 then actual[index] = 0
    else written[index] = 0
    end
  else
    wrong = wrong + 1
  end
end
for n = 0, 63 do actual[n], written[n] = 0, 0 end
local noise = 71
for n = 0, 399999 do
  noise = (noise * 69069 + 5) & 0xFFFFFFFF
  local high = noise >= 0x80000000 and 0xF0000000 or 0
  local first = ((((noise >> 4) | high) << 8) | 0x68) & 0xFFFFFFFF
  if n & 31 == 0 then first = first ~ 4 end
  serve(first, (noise ~ (n << 9)) & 0xFFFFFFFF)
end
for n = 0, 63 do result = result * 31 + actual[n] + written[n] end
result = (result ~ accepted ~ (foreign << 8) ~ (wrong << 16)) & 0xFFFFFFFF
print(result >= 0x80000000 and result - 0x100000000 or result)
