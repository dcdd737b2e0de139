// A folder with the FMUs of these tests and a plant that uses them.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/tools/command.hpp"

namespace ipos::tests {

class FmuFolder {
 public:
  FmuFolder() {
    for (const char* name : {"spring2.fmu", "spring3.fmu", "trouble.fmu"})
      std::filesystem::copy_file(std::filesystem::path(IPOS_FMUS) / name, folder_.path() / name);
  }
  const std::filesystem::path& path() const { return folder_.path(); }
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  CommandResult run(const std::vector<std::string>& arguments) const { return run_ipos(arguments, folder_.path()); }

  // A plant with a station `u`, whose program does nothing, and a machine of the trouble FMU that does `what` at 0.1 s.
  void write_trouble(int what, const std::string& more = "") const {
    write("p.toml", fmt::format("[[station]]\nname = \"u\"\nunit = \"md60a\"\n"
                                "[[machine]]\nname = \"wheel\"\nfmu = \"trouble.fmu\"\n{}\n"
                                "[machine.parameters]\nwhat = {}\n[machine.outputs]\ncount = \"u.H300\"\n",
                                more, what));
  }

 private:
  TemporaryFolder folder_;
};

// A drive whose shaft the spring turns: 1500 W at 1400 rpm are 10.23 Nm, and what it was told of its inertia is J1.
inline constexpr const char* kDriven = R"([[station]]
name = "u"
unit = "md60a"
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1
[station.analog]
AI1 = "10 V"
[station.load]
driven = true
inertia = 207
brake = false
[[machine]]
name = "spring"
fmu = "{}"
[machine.inputs]
torque = "u.torque"
[machine.outputs]
speed = "u.shaft_speed"
energy = "u.H300"
angle = "u.H301"
)";

// The values of signals in the trace of a run, a row a millisecond, which stands in front in ms.
std::vector<std::vector<double>> traced(const FmuFolder& folder, const std::string& plant, const std::string& signals,
                                        const std::string& length);

}  // namespace ipos::tests
