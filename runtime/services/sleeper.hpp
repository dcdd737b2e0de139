// Who may have left out milliseconds in which nothing happened. What comes from outside tells it before it
// looks at or touches anything that changes with time.
#pragma once

namespace ipos::runtime {

class Sleeper {
 public:
  // System variables may be written by somebody else than the program's own commands.
  virtual void touch() = 0;
  // Makes up for what was left out as far as variables show it. It may sleep on; true: then they stay as they
  // are, until it stirs its buses.
  virtual bool make_up_variables() = 0;
  // Makes up for everything, and from now on nothing is left out until it rests again: something will change.
  virtual void wake() = 0;

 protected:
  ~Sleeper() = default;
};

}  // namespace ipos::runtime
