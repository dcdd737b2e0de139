#include "tests/engines/campaign.hpp"

#include <istream>
#include <ostream>

#include "tests/engines/pair.hpp"

namespace ipos::tests {

void write(std::ostream& out, const EngineProgram& program) {
  const vm::Limits& limits = program.limits;
  out << program.name << '\n'
      << limits.variables << ' ' << limits.program_words << ' ' << int{limits.tasks} << ' '
      << int{limits.call_depth} << ' ' << program.seed << ' ' << program.orders << ' ' << program.code.size();
  for (const uint32_t word : program.code) out << ' ' << word;
  out << '\n';
}

bool read(std::istream& in, EngineProgram& program) {
  int tasks = 0, call_depth = 0;
  size_t words = 0;
  vm::Limits& limits = program.limits;
  if (!std::getline(in >> std::ws, program.name)) return false;
  in >> limits.variables >> limits.program_words >> tasks >> call_depth >> program.seed >> program.orders >>
      words;
  if (!in || words > limits.program_words) return false;
  limits.tasks = static_cast<uint8_t>(tasks);
  limits.call_depth = static_cast<uint8_t>(call_depth);
  program.code.resize(words);
  for (uint32_t& word : program.code) in >> word;
  return static_cast<bool>(in);
}

void EngineCampaign::run(const EngineProgram& program) {
  if (!difference.empty()) return;
  const vm::Verification verified = vm::verify(program.code, program.limits, {});
  if (!verified.image) {
    difference = program.name + " is not verified";
    return;
  }
  std::vector<vm::fast::Slot> slots(vm::fast::Predecoded::slots_needed(program.code.size()));
  const vm::fast::Predecoded predecoded(*verified.image, slots);
  for (uint32_t at = 0; at < program.code.size(); at += vm::decode(program.code, at).words)
    operations.insert(predecoded.operation(at));
  const PairRun pair = run_pair(*verified.image, program.seed, program.orders);
  ++programs;
  native += pair.native;
  orders += pair.orders;
  commands += pair.commands;
  if (!pair.difference.empty()) difference = program.name + ": " + pair.difference;
}

std::string EngineCampaign::summary() const {
  return std::to_string(programs) + " programs, " + std::to_string(native) + " of them as machine code, " +
         std::to_string(orders) + " orders, " + std::to_string(commands) + " commands, " +
         std::to_string(operations.size()) + " operations met" +
         (difference.empty() ? "" : "; " + difference);
}

}  // namespace ipos::tests
