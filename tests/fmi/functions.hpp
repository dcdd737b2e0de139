// Functions of FMI 2.0 and 3.0 as an importer declares them, and a plant whose files lie in a folder.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "runtime/fmi/package.hpp"
#include "runtime/library/session.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "tests/harness/reach.hpp"

extern "C" {
struct Fmi2Callbacks {
  void (*logger)(void*, const char*, int, const char*, const char*, ...);
  void* (*allocate)(size_t, size_t);
  void (*free)(void*);
  void (*step_finished)(void*, int);
  void* environment;
};
void* fmi2Instantiate(const char*, int, const char*, const char*, const Fmi2Callbacks*, int, int);
void fmi2FreeInstance(void*);
int fmi2SetDebugLogging(void*, int, size_t, const char* const*);
int fmi2SetupExperiment(void*, int, double, double, int, double);
int fmi2EnterInitializationMode(void*);
int fmi2ExitInitializationMode(void*);
int fmi2Terminate(void*);
int fmi2Reset(void*);
int fmi2GetReal(void*, const unsigned*, size_t, double*);
int fmi2GetInteger(void*, const unsigned*, size_t, int*);
int fmi2GetBoolean(void*, const unsigned*, size_t, int*);
int fmi2GetString(void*, const unsigned*, size_t, const char**);
int fmi2SetReal(void*, const unsigned*, size_t, const double*);
int fmi2SetInteger(void*, const unsigned*, size_t, const int*);
int fmi2SetBoolean(void*, const unsigned*, size_t, const int*);
int fmi2SetString(void*, const unsigned*, size_t, const char* const*);
int fmi2GetFMUstate(void*, void**);
int fmi2SetFMUstate(void*, void*);
int fmi2FreeFMUstate(void*, void**);
int fmi2SerializedFMUstateSize(void*, void*, size_t*);
int fmi2SerializeFMUstate(void*, void*, char*, size_t);
int fmi2DeSerializeFMUstate(void*, const char*, size_t, void**);
int fmi2DoStep(void*, double, double, int);
int fmi2CancelStep(void*);
int fmi2GetStatus(void*, int, int*);
int fmi2GetRealStatus(void*, int, double*);
int fmi2GetIntegerStatus(void*, int, int*);
int fmi2GetBooleanStatus(void*, int, int*);
int fmi2GetStringStatus(void*, int, const char**);
int fmi2GetRealOutputDerivatives(void*, const unsigned*, size_t, const int*, double*);
int fmi2SetRealInputDerivatives(void*, const unsigned*, size_t, const int*, const double*);
int fmi2GetDirectionalDerivative(void*, const unsigned*, size_t, const unsigned*, size_t, const double*, double*);

void* fmi3InstantiateCoSimulation(const char*, const char*, const char*, bool, bool, bool, bool, const uint32_t*, size_t, void*,
                                  void (*)(void*, int, const char*, const char*), void (*)());
void fmi3FreeInstance(void*);
int fmi3EnterInitializationMode(void*, bool, double, double, bool, double);
int fmi3ExitInitializationMode(void*);
int fmi3EnterEventMode(void*);
int fmi3UpdateDiscreteStates(void*, bool*, bool*, bool*, bool*, bool*, double*);
int fmi3EnterStepMode(void*);
int fmi3Terminate(void*);
int fmi3Reset(void*);
int fmi3GetFloat64(void*, const uint32_t*, size_t, double*, size_t);
int fmi3SetFloat64(void*, const uint32_t*, size_t, const double*, size_t);
int fmi3GetInt32(void*, const uint32_t*, size_t, int32_t*, size_t);
int fmi3GetInt64(void*, const uint32_t*, size_t, int64_t*, size_t);
int fmi3SetInt64(void*, const uint32_t*, size_t, const int64_t*, size_t);
int fmi3GetBoolean(void*, const uint32_t*, size_t, bool*, size_t);
int fmi3SetBoolean(void*, const uint32_t*, size_t, const bool*, size_t);
int fmi3GetClock(void*, const uint32_t*, size_t, bool*);
int fmi3SetClock(void*, const uint32_t*, size_t, const bool*);
int fmi3GetIntervalDecimal(void*, const uint32_t*, size_t, double*, int*);
int fmi3GetIntervalFraction(void*, const uint32_t*, size_t, uint64_t*, uint64_t*, int*);
int fmi3GetBinary(void*, const uint32_t*, size_t, size_t*, const uint8_t**, size_t);
int fmi3SetBinary(void*, const uint32_t*, size_t, const size_t*, const uint8_t* const*, size_t);
int fmi3GetFMUState(void*, void**);
int fmi3SetFMUState(void*, void*);
int fmi3FreeFMUState(void*, void**);
int fmi3DoStep(void*, double, double, bool, bool*, bool*, bool*, double*);
int fmi3EnterConfigurationMode(void*);
}

namespace ipos::tests {

enum { kOk = 0, kDiscard = 2, kError = 3 };

inline std::string bytes(std::initializer_list<int> values) {
  std::string out;
  for (const int value : values) out += static_cast<char>(value);
  return out;
}

// What the instances of a test have logged, each in a line.
struct Told {
  std::string text;
  static void fmi2(void* told, const char*, int, const char*, const char* text, ...) {
    static_cast<Told*>(told)->text += std::string(text) + "\n";
  }
  static void fmi3(void* told, int, const char*, const char* text) { static_cast<Told*>(told)->text += std::string(text) + "\n"; }
  bool has(const std::string& part) const { return text.find(part) != std::string::npos; }
};

// The resources of an FMU in a folder of their own, and the variables by their names. The program, if any, is P.IPC of station 1.
class Resources {
 public:
  explicit Resources(const std::string& plant, const std::string& program = "", fmi::Choice choice = {},
                     const std::string& folder_name = "resources");
  Resources(const Resources&) = delete;
  Resources& operator=(const Resources&) = delete;
  ~Resources();

  std::string folder() const { return folder_.string(); }
  std::string uri() const;
  const std::string& token() const { return package_.token; }
  const fmi::Variables& variables() const { return variables_; }
  uint32_t reference(const std::string& name) const;

  void* make2(Told& told) const;
  void* make3(Told& told, bool events = false, bool early = false) const;
  // The same, ready for its first step.
  void* begin2(Told& told) const;
  void* begin3(Told& told, bool events = false, bool early = false) const;

 private:
  std::filesystem::path above_, folder_;
  fmi::Package package_;
  fmi::Variables variables_;
  std::unique_ptr<library::Session> session_;
};

// A drive that turns at 1000 rpm after its ramp as soon as DI01 is there.
inline const std::string kTurning = R"(
[[station]]
name = "u"
unit = "mdxb"
[station.parameters]
P160 = "1000 rpm"
P601 = "ENABLE/RAP.STOP"
P602 = "NO FUNCTION"
P603 = "n11/n21"
P130 = "1 s"
[station.inputs]
DI00 = 1
DI02 = 1
DI04 = 1
)";

// The same with the program P.IPC.
inline std::string turning_with_program() {
  std::string plant = kTurning;
  return plant.insert(plant.find("[station.parameters]"), "program = \"P.IPC\"\n");
}

}  // namespace ipos::tests
