#include "bench.h"
#define RAMP 37
#define LIMIT 150000
int main(void) {
  int result = 0, target = 30000, setpoint = 0, speed = 0, integral = 0;
  for (int i = 0; i < 4000000; i++) {
    if (i % 5000 == 0) target = -target;
    if (setpoint < target) {
      setpoint += RAMP;
      if (setpoint > target) setpoint = target;
    } else if (setpoint > target) {
      setpoint -= RAMP;
      if (setpoint < target) setpoint = target;
    }
    int error = setpoint - speed;
    int p_part = error * 12;
    integral = integral + error / 4;
    if (integral > LIMIT) integral = LIMIT;
    if (integral < -LIMIT) integral = -LIMIT;
    int torque = p_part + integral;
    if (torque > LIMIT) torque = LIMIT;
    else if (torque < -LIMIT) torque = -LIMIT;
    speed = speed + (torque - speed * 3) / 256;
    result = result * 31 + speed;
  }
  PRINT(result);
}
