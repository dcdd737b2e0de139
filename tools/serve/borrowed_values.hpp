// Parameters of a real drive that manual operation has changed for a while (volatile), until the drive has taken its own
// values back. They are written down in the user's state folder before they are changed, so that the next start at this
// port knows what a killed one left behind.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/parameters/parameter_access.hpp"

namespace ipos::tools::serve {

class BorrowedValues {
 public:
  // Reads what an earlier start has written down, and asks the drive what of it is still so.
  BorrowedValues(ParameterAccess& access, const std::string& port, uint8_t address);

  // The value of a parameter; a Mistake says why the drive does not tell.
  int32_t read(uint16_t index);
  // Sets a parameter for a while. A Mistake or Refusal: it is not set.
  void set(uint16_t index, int32_t value);
  // Asks the drive once for each to take its own value back. True: all are.
  bool give_back();

  bool empty() const { return values_.empty(); }
  bool is_borrowed(uint16_t index) const;
  // Those that wait for the controller inhibit only.
  bool wait_for_inhibit() const;
  // "P100 is RS-485 in place of BIPOL./FIX.SETPT", and why it still is.
  std::vector<std::string> texts() const;

 private:
  struct Value {
    uint16_t index;
    int32_t before, during;
    bool needs_inhibit = false;  // was refused without
    std::string why;             // it was not taken back at the last try
  };
  std::string text_of(const Value& value) const;
  void write_down() const;

  ParameterAccess& access_;
  std::string port_;
  uint8_t address_;
  std::string file_;
  std::vector<Value> values_;
};

}  // namespace ipos::tools::serve
