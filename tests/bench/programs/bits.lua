local result, word = 0, 12345
for i = 1, 500000 do
  word = (word * 1103 + 12345) & 0xFFFFFFFF
  local reversed, ones = 0, 0
  for k = 0, 15 do
    reversed = reversed << 1
    if word & (1 << k) ~= 0 then
      reversed = reversed | 1
      ones = ones + 1
    end
  end
  local packed, digits = 0, word & 0x7FFF
  for k = 1, 4 do
    packed = (packed << 4) | digits % 10
    digits = digits // 10
  end
  result = (result ~ reversed) + (packed ~ ones)
end
result = result & 0xFFFFFFFF
print(result >= 0x80000000 and result - 0x100000000 or result)
