local result, px, py = 0, {}, {}
local function interpolate(at)
  local low, high = 0, 32
  while high - low > 1 do
    local middle = (low + high) >> 1
    if px[middle] <= at then low = middle else high = middle end
  end
  local rise = (py[low + 1] - py[low]) * (at - px[low])
  local run = px[low + 1] - px[low]
  if rise < 0 then return py[low] - -rise // run end
  return py[low] + rise // run
end
for i = 0, 32 do
  px[i] = i * i * 3 + i
  py[i] = (i * 7919) & 4095
end
for i = 0, 999999 do
  result = result * 3 + interpolate((i * 77) & 2047)
end
result = result & 0xFFFFFFFF
print(result >= 0x80000000 and result - 0x100000000 or result)
