local c, x = 0xFFFFFFFF, 1
for i = 1, 1048576 do
  x = (x * 69069 + 1) & 0xFFFFFFFF
  c = c ~ ((x >> 16) & 255)
  for k = 1, 8 do c = (c >> 1) ~ (0xEDB88320 & -(c & 1)) end
end
c = ~c & 0xFFFFFFFF
print(c >= 0x80000000 and c - 0x100000000 or c)
