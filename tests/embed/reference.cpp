// Runs, and the interpreter of the simulation through them.
#include "tests/embed/reference.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "compiler/compile.hpp"
#include "tests/fuzz/valid_code.hpp"
#include "tests/generated/pcg.hpp"
#include "vm/exec/machine.hpp"
#include "vm/exec/saved_state.hpp"
#include "vm/image/image.hpp"
#include "vm/sched/scheduler.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
}

}  // namespace

OrderedRun random_run(uint32_t number) {
  Pcg random(number);
  std::vector<uint8_t> bytes(64 + static_cast<size_t>(random.below(1500)));
  for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random.next());
  Input input(bytes.data(), bytes.size());
  vm::Image image;
  image.unit = number % 3 == 0 ? 1 : 4;
  image.code = valid_code(input, image.unit == 4 ? UnitShape{} : UnitShape{512, 2});
  return {"random " + std::to_string(number), vm::write_image(image), number * 2654435761U | 1U, 40};
}

std::vector<OrderedRun> language_runs() {
  std::vector<OrderedRun> runs;
  for (const char* folder : {IPOS_SOURCE_DIR "/tests/language", IPOS_SOURCE_DIR "/examples"})
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".IPC") continue;
      compiler::CompileOptions options;
      options.read_file = read_text;
      const std::string path = entry.path().string();
      const std::string text = read_text(path).value_or("");
      const auto wanted = text.find("// unit mdxb");
      if (wanted != std::string::npos) options.unit = stdlib::find_unit(std::string_view("mdxb"));
      const compiler::Compilation made = compiler::compile(path, path, text, options);
      if (made.image)
        runs.push_back({fs::relative(entry.path(), IPOS_SOURCE_DIR).string(), vm::write_image(*made.image), 7, 60});
    }
  std::sort(runs.begin(), runs.end(), [](const OrderedRun& a, const OrderedRun& b) { return a.name < b.name; });
  return runs;
}

struct Reference::Rig {
  Rig(std::vector<uint32_t> words, const stdlib::UnitType& its_unit, uint32_t seed)
      : unit(its_unit),
        code(std::move(words)),
        program(*vm::verify(code, {unit.variables, unit.program_words, unit.tasks, unit.call_depth}, {}).image),
        random{seed},
        machine(program, {this, execute, nullptr}) {
    for (uint32_t& rate : rates.commands) rate = chance_below(&random, 48);
    machine.start();
  }

  static vm::HostReply execute(void* self, vm::Machine& machine, int, const vm::Instruction& command) noexcept {
    auto& mine = *static_cast<Rig*>(self);
    const bool can_call = vm::coding(command.opcode).flow == vm::Flow::SystemCall;
    const host_answer answer = answer_of(&mine.random, can_call, mine.unit.variables);
    if (answer.writes) machine.variables()[answer.variable] = answer.value;
    return {static_cast<vm::Answer>(answer.answer), answer.fault, ""};
  }

  const stdlib::UnitType& unit;
  std::vector<uint32_t> code;
  vm::VerifiedImage program;
  chance random;
  vm::Rates rates;
  vm::Machine machine;
};

Reference::Reference(const OrderedRun& run) {
  vm::Image image = vm::read_image(run.image).image;
  rig_ = std::make_unique<Rig>(std::move(image.code), *stdlib::find_unit(image.unit), run.seed);
}
Reference::~Reference() = default;

bool Reference::tick() {
  vm::Machine& machine = rig_->machine;
  vm::run_tick(machine, rig_->rates);
  if (machine.fault().number != 0) return false;
  const order next = order_of(&rig_->random, rig_->unit.variables, rig_->unit.tasks);
  switch (next.kind) {
    case ORDER_NONE: break;
    case ORDER_WRITE: machine.variables()[next.number] = next.value; break;
    case ORDER_EVENT: machine.raise_event(static_cast<vm::Event>(next.number)); break;
    case ORDER_RESUME: machine.resume(static_cast<int>(next.number)); break;
    case ORDER_START: machine.start_task(static_cast<int>(next.number), 0); break;
    case ORDER_STOP: machine.stop_task(static_cast<int>(next.number)); break;
    case ORDER_FAULT: machine.raise_fault(static_cast<uint8_t>(next.number), "by chance"); break;
  }
  return machine.fault().number == 0;
}

std::vector<uint8_t> Reference::state() const {
  std::vector<uint8_t> bytes(vm::SavedState::size(rig_->program));
  vm::SavedState::write(rig_->machine, bytes.data());
  return bytes;
}

std::string Reference::fault_reason() const {
  const char* const reason = rig_->machine.fault().reason;
  return reason == nullptr ? "" : reason;
}

uint32_t reference_hash(const OrderedRun& run) {
  Reference reference(run);
  uint32_t hash = 2166136261U;
  const auto add = [&] {
    const std::vector<uint8_t> state = reference.state();
    hash = hash_of(hash, state.data(), static_cast<uint32_t>(state.size()));
  };
  for (uint32_t n = 0; n < run.ticks && reference.tick(); ++n)
    if (n % ORDERS_HASH_EVERY == 0) add();
  add();
  return hash;
}

}  // namespace ipos::tests
