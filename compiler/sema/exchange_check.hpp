// The data of MOVLNK that stay 0: values that the program reads and no exchange brings, and a parameter that is written
// without a value. Said only where the formats, services and data of all MOVLNK commands are known.
#pragma once

#include <map>
#include <set>

#include "compiler/sema/constant_flow.hpp"

namespace ipos::compiler {

class ExchangeCheck {
 public:
  ExchangeCheck(Context& context, const ProgramRoots& roots, const ConstantFlow& flow)
      : context_(context), roots_(roots), flow_(flow) {}

  void note(const ConstantFlow::Point& point);
  void run();  // when all commands have been noted

 private:
  // What the exchanges do with one MLDATA.
  struct Data {
    uint32_t words = 0;      // process data, at most
    bool parameter = false;  // a parameter channel
    bool reads = false;      // and it may bring a value
    std::set<const checked::Expr*> writes;  // commands that write a parameter for certain
  };

  void check(uint32_t first, const Data& data);
  // The MLDATA that begins there and that nobody but the program's own text and MOVLNK writes.
  const Variable* own_data(uint32_t first) const;
  const AccessPlace* alive(const std::vector<AccessPlace>& places) const;

  Context& context_;
  const ProgramRoots& roots_;
  const ConstantFlow& flow_;
  bool unknown_ = false;          // a command whose data may be any
  std::map<uint32_t, Data> data_;  // by first variable
  std::set<uint32_t> pointers_;    // DPointer of each MOVLNK
  std::set<uint32_t> brought_;     // variables that an exchange writes
};

}  // namespace ipos::compiler
