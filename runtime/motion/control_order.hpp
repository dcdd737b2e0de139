// What the drive tells the control of a motor with control = "real": the mode (P700) and the parameters that act on it.
#pragma once

#include <cstdint>

namespace ipos::runtime {

struct ControlOrder {
  bool encoder = false;       // speed control with feedback; else voltage and frequency
  bool hoist = false;         // the torque of the last stop is there before the brake opens (ours)
  bool dc_braking = false;    // stops by direct current instead of a ramp
  bool flying_start = false;  // a motor that turns is caught
  bool adjusted = true;       // P320: boost and IxR compensation are as the motor needs them
  int32_t start_stop = 0;     // P300, 1/1000 rpm
  int32_t slip_compensation = 0;  // P324, at rated torque, 1/1000 rpm
  int32_t boost = 0;          // P321, 1/1000 %
  int32_t ixr = 0;            // P322, 1/1000 %
  int32_t gain = 2'000;       // P200, 1/1000
  int32_t time_us = 10'000;   // P201
  int32_t precontrol = 0;     // P202, 1/1000
  int32_t precontrol_us = 0;  // P203
  int32_t filter_us = 0;      // P204
  int32_t load_precontrol = 0;  // P205: active current at the start, 1/1000 % of IN
};

}  // namespace ipos::runtime
