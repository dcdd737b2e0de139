// Who may have left out milliseconds in which nothing happened, or executes them later. What comes from
// outside tells it before it looks at or touches anything that changes with time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/bus/can/frame.hpp"

namespace ipos::runtime {

// Who puts telegrams of receive objects into variables.
class ObjectReader {
 public:
  virtual void read(size_t object, const Frame& frame) = 0;

 protected:
  ~ObjectReader() = default;
};

class Sleeper {
 public:
  // Call before a bus or a system command writes system variables.
  virtual void touch() = 0;
  // Makes up for what was left out as far as variables show it. It may sleep on; true: then they stay as they
  // are, until its buses want repeated frames again.
  virtual bool make_up_variables() = 0;
  // It executes its ticks when it has something to tell, or somebody looks.
  bool late() const { return late_; }
  // The program of one that is late has done all that it does up to now.
  void catch_up() {
    if (late_) run_late();
  }
  // True: the telegram waits until the program has come as far as now; then the reader reads it, once for all
  // that happens by then. Only for telegrams that do nothing but write variables.
  virtual bool keep(ObjectReader& reader, size_t object, const Frame& frame) = 0;
  // Behind catch_up(): a telegram writes variables, from this one on. It wakes, or goes on being late.
  virtual void expect_variables(uint32_t first) = 0;
  // Makes up for everything: all is as it is now.
  virtual void make_up() = 0;
  // The same, and from now on nothing is left out until it rests again: something will change.
  virtual void wake() = 0;

 protected:
  ~Sleeper() = default;
  virtual void run_late() = 0;

  bool late_ = false;
};

}  // namespace ipos::runtime
