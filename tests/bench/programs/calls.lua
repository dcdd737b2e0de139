local result, x, y, smallest, largest = 0, 300, 211, -20000, 20000
local function limit()
  if x < smallest then x = smallest end
  if x > largest then x = largest end
end
local function scale()
  x = x * y >> 8
  limit()
end
local function swap()
  x, y = y, x
end
local function turn()
  swap()
  scale()
  swap()
  scale()
end
for i = 0, 1999999 do
  turn()
  result = (result + x - y) & 0xFFFFFFFF
  x = (i & 1023) + 200
  y = (i & 511) + 100
end
print(result >= 0x80000000 and result - 0x100000000 or result)
