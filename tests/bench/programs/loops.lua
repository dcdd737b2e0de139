local s = 0
for i = 0, 299 do
  for j = 0, 299 do
    for k = 0, 299 do s = (s + i * j - k) ~ (k << 1) end
  end
end
s = s & 0xFFFFFFFF
print(s >= 0x80000000 and s - 0x100000000 or s)
