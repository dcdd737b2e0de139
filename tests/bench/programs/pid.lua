local RAMP, LIMIT = 37, 150000
local result, target, setpoint, speed, integral = 0, 30000, 0, 0, 0
for i = 0, 3999999 do
  if i % 5000 == 0 then target = -target end
  if setpoint < target then
    setpoint = setpoint + RAMP
    if setpoint > target then setpoint = target end
  elseif setpoint > target then
    setpoint = setpoint - RAMP
    if setpoint < target then setpoint = target end
  end
  local error = setpoint - speed
  local p_part = error * 12
  -- Written out: a call for each division would be measured instead.
  if error < 0 then integral = integral - -error // 4 else integral = integral + error // 4 end
  if integral > LIMIT then integral = LIMIT end
  if integral < -LIMIT then integral = -LIMIT end
  local torque = p_part + integral
  if torque > LIMIT then torque = LIMIT elseif torque < -LIMIT then torque = -LIMIT end
  local force = torque - speed * 3
  if force < 0 then speed = speed - -force // 256 else speed = speed + force // 256 end
  result = result * 31 + speed
end
result = result & 0xFFFFFFFF
print(result >= 0x80000000 and result - 0x100000000 or result)
