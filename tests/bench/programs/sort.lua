local result, seed, v = 0, 7, {}
for round = 1, 1500 do
  for i = 0, 99 do
    seed = seed * 1103 + 12345 & 0xFFFF
    v[i] = seed
  end
  for i = 1, 99 do
    local x, j = v[i], i - 1
    while j >= 0 and v[j] > x do
      v[j + 1] = v[j]
      j = j - 1
    end
    v[j + 1] = x
  end
  result = result + v[50] - v[10]
end
print(result)
