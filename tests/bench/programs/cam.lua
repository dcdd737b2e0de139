local POINTS, RECORD = 16, 2
local result, points = 0, {}
local function follow(disk, angle)
  local point = disk * POINTS * RECORD
  local last = point + (POINTS - 2) * RECORD
  while points[point + 2] <= angle do
    point = point + RECORD
    if point >= last then break end
  end
  local width = points[point + 2] - points[point]
  local rise = (points[point + 3] - points[point + 1]) * (angle - points[point])
  if rise < 0 then return points[point + 1] - -rise // width end
  return points[point + 1] + rise // width
end
local point = 0
for disk = 0, 3 do
  for k = 0, POINTS - 1 do
    points[point] = k * (38 + disk * 2) + (k & 3) * disk
    points[point + 1] = (k * 5851 + disk * 977) & 2047
    point = point + RECORD
  end
end
for turn = 0, 599999 do
  result = result * 5 + follow(turn & 3, (turn * 29) & 511)
end
result = result & 0xFFFFFFFF
print(result >= 0x80000000 and result - 0x100000000 or result)
