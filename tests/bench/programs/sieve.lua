local SIZE, flags, result = 900, {}, 0
for round = 1, 20000 do
  result = 0
  for i = 0, SIZE - 1 do flags[i] = 1 end
  for i = 2, SIZE - 1 do
    if flags[i] ~= 0 then
      for k = i + i, SIZE - 1, i do flags[k] = 0 end
      result = result + 1
    end
  end
end
print(result)
