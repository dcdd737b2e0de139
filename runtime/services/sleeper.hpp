// Who may have left out milliseconds in which nothing happened, or executes them later. What comes from
// outside tells it before it looks at or touches anything that changes with time.
#pragma once

namespace ipos::runtime {

class Sleeper {
 public:
  // System variables may be written by somebody else than the program's own commands.
  virtual void touch() = 0;
  // Makes up for what was left out as far as variables show it. It may sleep on; true: then they stay as they
  // are, until it stirs its buses.
  virtual bool make_up_variables() = 0;
  // Variables will be written: makes up for everything. Who is late with its ticks may go on so.
  virtual void expect_variables() = 0;
  // Makes up for everything, and from now on nothing is left out until it rests again: something will change.
  virtual void wake() = 0;
  // Executes the ticks it is late with.
  void catch_up() {
    if (late_) make_up();
  }

 protected:
  ~Sleeper() = default;
  virtual void make_up() = 0;

  bool late_ = false;
};

}  // namespace ipos::runtime
