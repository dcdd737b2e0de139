// Seeded orders and the hash of states.
#include "tests/runtime/motion/order_mix.hpp"

namespace ipos::tests {

using runtime::AxisCommand;
using runtime::AxisOrder;
using runtime::AxisState;
using runtime::MachineData;

namespace {

int32_t below(std::mt19937_64& random, int32_t end) {
  return static_cast<int32_t>(random() % static_cast<uint64_t>(end));
}

// Any value, the ends of the range often.
int32_t any(std::mt19937_64& random) {
  constexpr int32_t kEnds[] = {0, 1, -1, INT32_MAX, INT32_MIN, INT32_MAX - 1, INT32_MIN + 1, 1'000'000};
  if (random() % 3 == 0) return kEnds[random() % 8];
  return static_cast<int32_t>(random()) >> (random() % 31);
}

uint32_t any_time(std::mt19937_64& random) {
  constexpr uint32_t kTimes[] = {0, 1, 2, 3, 7, 100, 1'000, 1'999, 2'000'000, 2'000'001, UINT32_MAX};
  return kTimes[random() % 11];
}

}  // namespace

AxisOrder draw_order(std::mt19937_64& random, Taste taste) {
  AxisOrder order;
  order.command = static_cast<AxisCommand>(random() % 6);
  order.ramp.s_pattern = static_cast<uint8_t>(random() % 5);
  order.brake_function = random() % 4 != 0;
  order.premagnetize_ms = static_cast<uint16_t>(random() % 50);
  order.control.encoder = random() % 2 == 0;
  order.control.hoist = random() % 4 == 0;
  order.control.dc_braking = random() % 4 == 0;
  order.control.flying_start = random() % 2 == 0;
  order.control.adjusted = random() % 2 == 0;
  order.brake_release_ms = static_cast<uint16_t>(random() % 50);
  order.brake_apply_ms = static_cast<uint16_t>(random() % 50);
  if (taste == Taste::Any) {
    order.target = any(random);
    order.ramp.up_cw_ms = any_time(random);
    order.ramp.down_cw_ms = any_time(random);
    order.ramp.up_ccw_ms = any_time(random);
    order.ramp.down_ccw_ms = any_time(random);
    order.stop_ramp_ms = any_time(random);
    order.current = any(random);
    order.speed_limit = any(random);
    order.current_limit = any(random);
    order.load_torque = any(random);
    order.standstill_current = any(random);
    for (int32_t* figure : {&order.control.start_stop, &order.control.slip_compensation, &order.control.boost,
                            &order.control.ixr, &order.control.gain, &order.control.time_us})
      *figure = any(random);
    return order;
  }
  order.target = below(random, 6'000'001) - 3'000'000;
  order.ramp.up_cw_ms = static_cast<uint32_t>(1 + random() % 4'000);
  order.ramp.down_cw_ms = static_cast<uint32_t>(1 + random() % 4'000);
  order.ramp.up_ccw_ms = static_cast<uint32_t>(1 + random() % 4'000);
  order.ramp.down_ccw_ms = static_cast<uint32_t>(1 + random() % 4'000);
  order.stop_ramp_ms = static_cast<uint32_t>(random() % 2'000);
  order.current = below(random, 300'001) - 150'000;
  order.speed_limit = below(random, 3'000'001);
  order.current_limit = below(random, 150'001);
  order.load_torque = below(random, 40'001) - 20'000;
  order.standstill_current = below(random, 2) * 20'000;
  order.control.start_stop = below(random, 150'001);
  order.control.slip_compensation = below(random, 200'001);
  order.control.ixr = below(random, 100'001);
  order.control.gain = 100 + below(random, 31'901);
  order.control.time_us = below(random, 100'001);
  return order;
}

MachineData draw_machine(std::mt19937_64& random, Taste taste) {
  MachineData machine;
  machine.brake = random() % 2 == 0;
  machine.braking_resistor = random() % 2 == 0;
  if (taste == Taste::Detailed || (taste == Taste::Any && random() % 2 == 0)) {
    machine.real = random() % 4 != 0;
    machine.load_shape = static_cast<runtime::LoadShape>(random() % 3);
    machine.load_torque = below(random, 100'001) - 50'000;
    machine.brake_release_ms = below(random, 200);
    machine.brake_apply_ms = below(random, 200);
    if (random() % 2 == 0) {
      machine.second_inertia = 1e-4 * (1 + below(random, 1'000));
      machine.stiffness = below(random, 1'000);
      machine.damping = 1e-3 * below(random, 100);
      machine.backlash = 1e-3 * below(random, 100);
    }
  }
  if (taste != Taste::Any) {
    machine.inertia = below(random, 2'000);
    machine.friction = below(random, 20'000);
    return machine;
  }
  for (int32_t* figure : {&machine.ramp_reference,
                          &machine.rated_speed,
                          &machine.rated_slip,
                          &machine.pole_pairs,
                          &machine.rated_power,
                          &machine.rated_active_current,
                          &machine.magnetizing_current,
                          &machine.rotor_run_up_ms,
                          &machine.motor_heat_time_ms,
                          &machine.inertia,
                          &machine.friction,
                          &machine.load_torque,
                          &machine.load_turns,
                          &machine.run_up_us,
                          &machine.breakdown_torque,
                          &machine.stator_drop,
                          &machine.brake_release_ms,
                          &machine.brake_apply_ms,
                          &machine.unit_power,
                          &machine.unit_current,
                          &machine.noise,
                          &machine.brake_torque,
                          &machine.dc_link,
                          &machine.chopper_level,
                          &machine.continuous_current,
                          &machine.unit_heat_time_ms,
                          &machine.ambient,
                          &machine.heat_sink_rise,
                          &machine.heat_sink_time_ms})
    *figure = any(random);
  for (double* figure : {&machine.second_inertia, &machine.stiffness, &machine.damping, &machine.backlash})
    if (random() % 2 == 0) *figure = any(random) * (random() % 2 == 0 ? 1e-6 : 1.0);
  return machine;
}

uint64_t add_to_hash(uint64_t hash, const AxisState& state) {
  const auto add = [&hash](int64_t value) {
    for (int byte = 0; byte < 8; ++byte)
      hash = (hash ^ ((static_cast<uint64_t>(value) >> (8 * byte)) & 0xFF)) * 0x100000001B3;
  };
  for (const bool flag :
       {state.output_stage, state.brake_released, state.standing, state.ramping, state.current_limited})
    add(flag);
  for (const int32_t value : {static_cast<int32_t>(state.phase), state.setpoint, state.speed, state.position,
                              state.torque, state.output_current, state.active_current, state.frequency,
                              state.dc_link, state.heat_sink, state.utilization, state.motor_utilization})
    add(value);
  add(state.energy);
  return hash;
}

uint64_t hash_of_run(uint64_t seed, uint64_t ticks, Taste taste) {
  std::mt19937_64 random(seed);
  runtime::Axis axis(draw_machine(random, taste));
  AxisOrder order;
  uint64_t hash = 0xCBF29CE484222325, until_next = 0;
  for (uint64_t tick = 0; tick < ticks; ++tick, --until_next) {
    if (until_next == 0) {
      order = draw_order(random, taste);
      until_next = 1 + random() % 400;
    }
    hash = add_to_hash(hash, axis.tick(order));
  }
  return hash;
}

}  // namespace ipos::tests
