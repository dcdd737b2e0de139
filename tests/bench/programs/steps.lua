-- Bits are set by operators, not by functions: a call for each would be measured instead.
local result, step, outputs, settle, limit, done, rejected, noise, last = 0, 0, 0, 0, 0, 0, 0, 1913, 0
for cycle = 1, 3000000 do
  if settle > 0 then settle = settle - 1 end
  if limit > 0 then limit = limit - 1 end
  noise = (noise * 1229 + 351) & 0xFFFF
  local inputs = noise >> 7
  if step == 0 then
    if inputs & 2 ~= 0 then outputs = outputs | 2; settle = 6; limit = 30; step = 1 end
  elseif step == 1 then
    if settle == 0 and inputs & 1 ~= 0 then outputs = outputs & ~2 | 16; limit = 11; step = 2 end
  elseif step == 2 then
    if inputs & 0x30 == 0x30 then settle = 5; step = 3 elseif limit == 0 then step = 6 end
  elseif step == 3 then
    outputs = outputs & ~64 | ((inputs >> 3) & 1) << 6
    if settle == 0 then step = 4 end
  elseif step == 4 then
    done = done + 1; last = outputs; settle = 3; step = 5
  elseif step == 5 then
    outputs = outputs & ~4 | (~inputs & 1) << 2
    if settle == 0 then outputs = outputs & ~0x50; step = 0 end
  elseif step == 6 then
    rejected = rejected + 1; outputs = outputs | 128; settle = 18; step = 7
  elseif step == 7 then
    if settle == 0 and inputs & 4 ~= 0 then outputs = outputs & ~128; step = 0 end
  end
  result = result * 3 + outputs + step
end
result = (result ~ done ~ (rejected << 16) ~ last) & 0xFFFFFFFF
print(result >= 0x80000000 and result - 0x100000000 or result)
