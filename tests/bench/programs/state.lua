local result, state, count = 0, 0, 0
for i = 1, 20000000 do
  if state == 0 then state = 1
  elseif state == 1 then count = count + 1; state = 2
  elseif state == 2 then if count & 1 ~= 0 then state = 4 else state = 3 end
  elseif state == 3 then result = result + count; state = 5
  elseif state == 4 then result = result - 3; state = 6
  elseif state == 5 then state = 7
  elseif state == 6 then result = result ~ count; state = 7
  elseif state == 7 then state = 0
  end
end
result = result & 0xFFFFFFFF
print(result >= 0x80000000 and result - 0x100000000 or result)
