local result, longest = 0, 0
for i = 1, 299999 do
  local n, length = i, 1
  while n ~= 1 do
    if n & 1 ~= 0 then
      if n > 715827882 then break end
      n = n * 3 + 1
    else
      n = n >> 1
    end
    length = length + 1
  end
  if length > longest then
    longest = length
    result = i
  end
end
print(result)
