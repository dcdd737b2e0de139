// A travel from rest to rest in closed form, by school physics and in floating point: independent of the code
// under test.
#pragma once

#include <cmath>
#include <numbers>

namespace ipos::tests {

struct ClosedForm {
  double distance;  // increments
  double top;       // increments a ms
  double up, down;  // increments a ms²

  // Speeds in rpm, ramps in ms for 3000 rpm, 4096 increments a turn.
  ClosedForm(double increments, double rpm, double up_ms, double down_ms)
      : distance(std::abs(increments)),
        top(rpm * 4096 / 60000),
        up(3000.0 * 4096 / 60000 / up_ms),
        down(3000.0 * 4096 / 60000 / down_ms) {}

  bool triangle() const { return top * top / 2 * (1 / up + 1 / down) > distance; }
  double peak() const { return triangle() ? std::sqrt(2 * distance / (1 / up + 1 / down)) : top; }
  double up_time() const { return peak() / up; }
  double down_time() const { return peak() / down; }
  double cruise_time() const { return (distance - peak() * (up_time() + down_time()) / 2) / peak(); }
  double duration() const { return up_time() + cruise_time() + down_time(); }

  // Way after t ms with constant acceleration.
  double linear(double t) const {
    if (t >= duration()) return distance;
    if (t < up_time()) return up * t * t / 2;
    const double left = duration() - t;
    if (left < down_time()) return distance - down * left * left / 2;
    return peak() * up_time() / 2 + peak() * (t - up_time());
  }
  // The speed follows half a cosine in each ramp.
  double sine(double t) const {
    const auto ramp = [&](double time, double length) {
      return peak() * (time / 2 - length / (2 * std::numbers::pi) * std::sin(std::numbers::pi * time / length));
    };
    if (t >= duration()) return distance;
    if (t < up_time()) return ramp(t, up_time());
    const double left = duration() - t;
    if (left < down_time()) return distance - ramp(left, down_time());
    return peak() * up_time() / 2 + peak() * (t - up_time());
  }
  // The acceleration rises and falls evenly, as a triangle.
  double squared(double t) const {
    const auto ramp = [&](double time, double length) {
      const double x = time / length;
      const double share = x < 0.5 ? 2 * x * x * x / 3 : x - 0.5 + 2 * std::pow(1 - x, 3) / 3;
      return peak() * length * share;
    };
    if (t >= duration()) return distance;
    if (t < up_time()) return ramp(t, up_time());
    const double left = duration() - t;
    if (left < down_time()) return distance - ramp(left, down_time());
    return peak() * up_time() / 2 + peak() * (t - up_time());
  }
};

}  // namespace ipos::tests
