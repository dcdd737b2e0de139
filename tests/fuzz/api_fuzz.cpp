// The C API (embed/include/ipos.h) under sequences of calls: an image of any kind; up to three machines
// of it whose callbacks fail, call back and use the other machines; wrong arguments; memory that is too small
// or crooked; non-volatile memory and saved states that were changed. Every object lies in heap memory of
// exactly its size, so the sanitizers see each step beyond it. Time and commands are bounded, so that an
// execution stays short.
#include <ipos.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include "tests/fuzz/valid_code.hpp"
#include "vm/image/image.hpp"

using namespace ipos;         // NOLINT
using namespace ipos::tests;  // NOLINT

namespace {

constexpr int kMostCalls = 48;
constexpr uint32_t kMostTicks = 8;
constexpr uint32_t kMostRate = 32;       // commands a tick of one task
constexpr uint64_t kMostCommands = 512;  // of all machines; when they are spent, runs are asked for nothing
constexpr int kMostSaves = 2;            // saving and restoring are the most expensive calls
constexpr int kDeepest = 2;              // calls in callbacks in calls

// Heap memory of 8-byte alignment, displaced if wanted.
class Memory {
 public:
  explicit Memory(size_t size, size_t shift = 0) : bytes_(new uint8_t[size + shift]), shift_(shift) {}
  uint8_t* at() const { return bytes_.get() + shift_; }

 private:
  std::unique_ptr<uint8_t[]> bytes_;
  size_t shift_;
};

struct Session;

// A machine and its host.
struct Station {
  explicit Station(Session& all) : session(all) {}

  Session& session;
  Memory memory{ipos_vm_size()};
  ipos_vm* vm = nullptr;
  int inside = 0;  // callbacks of this machine that have not returned
  uint64_t time = 0;
  std::vector<uint8_t> saved;
  std::array<uint8_t, IPOS_NV_BYTES> nv{};
};

struct Session {
  explicit Session(const Input& input) : in(input) {}

  Input in;
  ipos_program* program = nullptr;
  ipos_program_info info{};
  std::vector<std::unique_ptr<Station>> stations;
  uint64_t commands_left = kMostCommands;
  int saves_left = kMostSaves;
  int depth = 0;
};

void call(Session& session, Station* self);

// While it exists, a callback of the station runs; it may call the library itself.
class InCallback {
 public:
  explicit InCallback(void* user) : station_(*static_cast<Station*>(user)) {
    ++station_.inside;
    Session& session = station_.session;
    if (session.depth >= kDeepest || session.in.u8() % 4 != 1) return;
    ++session.depth;
    call(session, &station_);
    --session.depth;
  }
  ~InCallback() { --station_.inside; }
  InCallback(const InCallback&) = delete;
  InCallback& operator=(const InCallback&) = delete;

  Station& station() { return station_; }
  Input& in() { return station_.session.in; }

 private:
  Station& station_;
};

ipos_reply command(void* user, ipos_vm* vm, const ipos_command* command) {
  require(command->context >= 1 && command->context <= 10, "a command has a context");
  InCallback here(user);
  require(vm == here.station().vm, "a callback is told its machine");
  return {here.in().u8() % 5, static_cast<uint8_t>(here.in().u8() % 3), nullptr};
}
void cancel(void* user, ipos_vm*, uint8_t context) {
  require(context >= 1 && context <= 10, "what was waited for has a context");
  InCallback here(user);
}
ipos_sending send(void* user, ipos_vm*, const ipos_frame* frame, uint32_t) {
  require(frame->length <= 8 && frame->id < 2048, "a frame is one of CAN");
  for (size_t n = frame->length; n < 8; ++n) require(frame->data[n] == 0, "bytes beyond the length are 0");
  InCallback here(user);
  return here.in().u8() % 4;
}
uint64_t time_us(void* user) {
  InCallback here(user);
  const uint64_t passed = here.in().u8();
  return here.station().time += passed < 250 ? passed * 100 : passed << 40;
}
bool nv_write(void* user, uint32_t offset, const void* bytes, uint32_t size) {
  InCallback here(user);
  auto& nv = here.station().nv;
  require(size <= nv.size() && offset <= nv.size() - size, "non-volatile memory has its size");
  if (here.in().u8() % 4 == 1) return false;
  std::memcpy(nv.data() + offset, bytes, size);
  return true;
}
bool nv_read(void* user, uint32_t offset, void* bytes, uint32_t size) {
  InCallback here(user);
  const auto& nv = here.station().nv;
  require(size <= nv.size() && offset <= nv.size() - size, "non-volatile memory has its size");
  if (here.in().u8() % 8 == 1) return false;
  std::memcpy(bytes, nv.data() + offset, size);
  return true;
}
void fault(void* user, ipos_vm*, const ipos_fault* fault) {
  require(fault->number != 0 && fault->reason != nullptr, "a fault has a number and a text");
  InCallback here(user);
}
void trace(void* user, ipos_vm*, const ipos_step* step) {
  require(step->address < static_cast<Station*>(user)->session.info.words, "a step is in the program");
  InCallback here(user);
}

ipos_host host_of(Station& station, uint8_t which) {
  return {&station,
          which & 1 ? command : nullptr,
          which & 2 ? cancel : nullptr,
          which & 4 ? send : nullptr,
          which % 16 != 6 ? time_us : nullptr,
          which & 8 ? nv_write : nullptr,
          which & 16 ? nv_read : nullptr,
          which & 32 ? fault : nullptr,
          which >> 6 == 3 ? trace : nullptr};
}

// Every answer is a status with a text.
ipos_status known(ipos_status status) {
  require(*ipos_status_text(status) != '\0', "an answer is one of the statuses");
  return status;
}

// The answer of a function that is not for callbacks.
ipos_status outside(const Station& station, ipos_status status) {
  require(station.inside == 0 || status == IPOS_BUSY || status == IPOS_INVALID_ARGUMENT ||
              status == IPOS_NO_CALLBACK || status == IPOS_MEMORY_TOO_SMALL,
          "a function that is not for callbacks does nothing in them");
  return known(status);
}

void spend(Session& session, uint64_t commands) {
  session.commands_left -= std::min(commands, session.commands_left);
}

void check_progress(Session& session, const ipos_progress& progress, uint32_t most) {
  require(progress.ticks <= most, "no more ticks than asked for");
  require(progress.commands <= 3 * kMostRate * (progress.ticks + 1), "no more commands than the rates allow");
  spend(session, progress.commands);
}

void seal(std::vector<uint8_t>& bytes) {
  const uint32_t checksum = vm::crc32(std::span(bytes).first(bytes.size() - 4));
  for (uint32_t n = 0; n < 4; ++n) bytes[bytes.size() - 4 + n] = static_cast<uint8_t>(checksum >> (8 * n));
}

void save(Station& station, ipos_vm* vm, uint8_t twist) {
  if (station.session.saves_left == 0) return;
  --station.session.saves_left;
  std::vector<uint8_t> state(ipos_state_size(station.vm) - (twist == 253 ? 1 : 0));
  const ipos_status status =
      outside(station, ipos_save(vm, twist == 254 ? nullptr : state.data(), state.size()));
  require(status == IPOS_OK || station.inside != 0 || twist >= 253, "a machine can be saved");
  if (status == IPOS_OK) station.saved = std::move(state);
}

// A state of this or another machine of the program, with some bytes changed; mostly in the tasks and
// telegrams at its ends, less in the variables between them. One that is accepted has to be the one that is
// saved again.
void restore(Station& station, const Station& from, ipos_vm* vm, uint8_t twist) {
  Input& in = station.session.in;
  std::vector<uint8_t> state = from.saved;
  if (state.empty() || station.session.saves_left == 0) return;
  --station.session.saves_left;
  const uint8_t changes = in.u8() % 4;
  for (int n = 0; n < changes; ++n) {
    const uint32_t at = in.u16();
    const uint32_t place = at % 4 < 2    ? at / 4 % 1024
                           : at % 4 == 2 ? static_cast<uint32_t>(state.size()) - 1 - at / 4 % 512
                                         : at;
    state[place % state.size()] = in.u8();
  }
  if (changes != 0 && in.u8() % 8 != 0) seal(state);
  const size_t size = state.size() - (twist == 253 ? 4 : 0);
  const ipos_status status = outside(station, ipos_restore(vm, twist == 254 ? nullptr : state.data(), size));
  require(changes != 0 || &station != &from || status == IPOS_OK || station.inside != 0 || twist >= 253,
          "what was saved is restored");
  if (status != IPOS_OK) return;
  std::vector<uint8_t> again(state.size());
  require(ipos_save(vm, again.data(), again.size()) == IPOS_OK, "a machine can be saved");
  require(state == again, "what was restored is saved as it was");
}

void init(Station& station, uint8_t twist) {
  const Session& session = station.session;
  const ipos_host host = host_of(station, station.session.in.u8());
  const size_t size = ipos_vm_size() - (twist == 253 ? 1 : 0);
  ipos_vm* made = nullptr;
  const ipos_status status = known(ipos_init(twist == 252   ? station.memory.at() + 4
                                             : twist == 251 ? nullptr
                                                            : station.memory.at(),
                                             size, twist == 255 ? nullptr : session.program,
                                             twist == 250 ? nullptr : &host, twist == 254 ? nullptr : &made));
  require((status == IPOS_OK) == (twist < 251), "a machine is made where there is memory");
  if (status != IPOS_OK) return;
  station.vm = made;
  station.saved.clear();
  require(ipos_program_of(made) == session.program && ipos_ticks(made) == 0, "a machine begins");
}

// Structures of variable telegrams at all the places where commands look for them (valid_code.hpp); bit n of
// `kinds` makes the one at H(8 n) a cyclic one. Most of them are in order.
void write_telegrams(Station& station, Input& in) {
  const uint32_t kinds = in.u16();
  const int32_t format = in.u8() % 10 + (kinds & 1 ? 0x100 : 0);
  const int32_t first_id = in.u8() % 8 != 0 ? 1200 : in.u16() % 2100;
  const int32_t cycle = 1 + in.u8() % 10, offset = in.u8() % 4 * 10, data = in.u8() * 4;
  for (int32_t n = 0; n < 16; ++n) {
    const int32_t id = first_id + n % 12;
    const int32_t cyclic[] = {id, n % 2 == 0 ? 10 * cycle : cycle, offset, format, data};
    const int32_t other[] = {id, format, data};
    const bool is_cyclic = (kinds >> static_cast<uint32_t>(n) & 1) != 0;
    uint32_t at = static_cast<uint32_t>(n) * 8;
    for (const int32_t value : is_cyclic ? std::span<const int32_t>(cyclic) : other)
      known(ipos_write(station.vm, at++, value));
  }
}

void look_around(const Session& session, ipos_vm* vm, uint8_t twist, Input& in) {
  const uint8_t number = in.u8();
  ipos_program_info info;
  known(ipos_program_info_of(twist == 255 ? nullptr : session.program, twist == 254 ? nullptr : &info));
  ipos_symbol symbol;
  if (known(ipos_symbol_at(ipos_program_of(vm), number % 4, twist == 254 ? nullptr : &symbol)) == IPOS_OK)
    require(symbol.count != 0 && number % 4 < session.info.symbols, "a symbol has variables");
  ipos_task task;
  if (known(ipos_task_of(vm, number % 12, twist == 254 ? nullptr : &task)) == IPOS_OK)
    require(task.depth <= session.info.call_depth &&
                (task.state == IPOS_TASK_STOPPED || task.address < session.info.words),
            "a task is sound");
  ipos_fault fault;
  if (known(ipos_fault_of(vm, twist == 254 ? nullptr : &fault)) == IPOS_OK)
    require(fault.reason != nullptr, "a fault has a text");
  require(ipos_version() == IPOS_VERSION && ipos_most_variables() >= session.info.variables &&
              ipos_most_words() >= session.info.words &&
              (ipos_features() & ~IPOS_FEATURE_FAST) == 2 + 4 + 8 + 16,
          "the library is what its header says");
  require(ipos_rule_text(number) != nullptr && ipos_status_text(number) != nullptr, "texts are texts");
  if (int32_t* const h = ipos_variables(vm)) h[session.info.variables - 1U] = h[0];
  require(ipos_state_size(vm) != 0 || vm == nullptr, "a machine has a state");
}

void use_symbol(ipos_vm* vm, uint8_t twist, Input& in) {
  static constexpr const char* kNames[] = {"abc", "a", "H5", "H01023", "H1023", "H1024", "", "H"};
  const uint8_t which = in.u8();
  const char chosen[] = {static_cast<char>(in.u8()), static_cast<char>(in.u8()), '\0'};
  const char* const name = twist == 254 ? nullptr : which & 8 ? chosen : kNames[which % 8];
  int32_t value = 0;
  known(ipos_write_symbol(vm, name, in.i32()));
  known(ipos_read_symbol(vm, name, twist == 253 ? nullptr : &value));
}

// One call, in a callback of `self` if there is one. Some arguments are wrong: `twist`.
void call(Session& session, Station* self) {
  Input& in = session.in;
  if (in.empty()) return;
  const uint8_t which = in.u8();
  const uint8_t twist = in.u8();
  const size_t other = which / 32U % session.stations.size();
  Station& station = self != nullptr && which < 192 ? *self : *session.stations[other];
  ipos_vm* const vm = twist == 255 ? nullptr : station.vm;
  const bool null = twist == 254;  // for the other pointer
  ipos_progress progress{};
  switch (which % 32) {
    case 0:
    case 1:
    case 2: {
      const uint32_t most = session.commands_left == 0 ? 0 : in.u8() % kMostTicks;
      outside(station, ipos_run_ticks(vm, most, null ? nullptr : &progress));
      check_progress(session, progress, most);
      if (null) spend(session, most * 3);
      break;
    }
    case 3: {
      const uint32_t most = session.commands_left == 0 ? 0 : in.u8();
      uint32_t done = 0;
      outside(station, ipos_run_commands(vm, 1 + in.u8() % 4, most, null ? nullptr : &done));
      require(done <= most, "no more commands than asked for");
      spend(session, null ? most : done);
      break;
    }
    case 4: {
      const uint32_t most = session.commands_left == 0 ? 0 : in.u8() % kMostTicks;
      outside(station, ipos_run_due(vm, most, &progress));
      check_progress(session, progress, most);
      break;
    }
    case 5: outside(station, ipos_start(vm)); break;
    case 6: outside(station, ipos_stop(vm)); break;
    case 7: {
      const uint32_t rates[3] = {in.u8() % kMostRate, in.u8() % kMostRate, in.u8() % kMostRate};
      known(ipos_set_rates(vm, null ? nullptr : rates));
      break;
    }
    case 8:
      outside(station,
              ipos_set_sbus(vm, in.u16() * 16U + twist % 2, in.u8() % 66, in.u8() % 66, in.u16() % 2080));
      break;
    case 9: known(ipos_write(vm, in.u16() % 1100, in.i32())); break;
    case 10: {
      int32_t value = 0;
      known(ipos_read(vm, in.u16() % 1100, null ? nullptr : &value));
      break;
    }
    case 11: known(ipos_start_task(vm, in.u8() % 5, in.u8())); break;
    case 12: known(ipos_stop_task(vm, in.u8() % 5)); break;
    case 13: known(ipos_resume(vm, in.u8() % 12)); break;
    case 14: known(ipos_raise_event(vm, in.u8() % 5 - 1)); break;
    case 15: outside(station, ipos_raise_fault(vm, in.u8(), null ? nullptr : "by chance")); break;
    case 16:
    case 17: {
      const uint8_t id = in.u8();
      ipos_frame frame{
          static_cast<uint16_t>(id < 192 ? 1200 + id % 8 : id * 9), static_cast<uint8_t>(in.u8() % 10), {}};
      for (uint8_t& byte : frame.data) byte = in.u8();
      known(ipos_receive(vm, null ? nullptr : &frame));
      break;
    }
    case 18: {
      const uint32_t tag = in.u32();
      known(ipos_sent(vm, tag & 1 ? tag : 0x10000 + tag / 2 % 1100, in.u8() % 2 != 0));
      break;
    }
    case 19: outside(station, ipos_nv_store(vm)); break;
    case 20: outside(station, ipos_nv_load(vm)); break;
    case 21: station.nv[in.u16() % station.nv.size()] ^= in.u8(); break;
    case 22: use_symbol(vm, twist, in); break;
    case 23: look_around(session, vm, twist, in); break;
    case 24: {
      const int32_t factor = in.u8(), most = 1 + in.u8() * 16;
      for (int32_t n = 0; n < session.info.variables; ++n) ipos_variables(station.vm)[n] = n * factor % most;
      break;
    }
    case 25: write_telegrams(station, in); break;
    case 26: save(station, vm, twist); break;
    case 27: restore(station, *session.stations[in.u8() % session.stations.size()], vm, twist); break;
    case 28:
      if (self == nullptr) init(station, twist);
      break;
    case 29: require(ipos_ticks(vm) < uint64_t{1} << 63, "ticks do not overflow"); break;
    default: outside(station, ipos_start(vm)); break;
  }
}

// Raw bytes, or a container around code words, around a valid program for one of the units, or around one
// that is changed or cut afterwards; mostly with a checksum that is right. `valid`: it has to be accepted.
std::vector<uint8_t> make_image(Input& in, bool& valid) {
  const uint8_t kind = in.u8();
  Input choices = in.part(in.u8());
  std::vector<uint8_t> bytes;
  if (kind % 8 == 0) {
    bytes.assign(choices.rest(), choices.rest() + choices.left());
    if (kind & 8 && bytes.size() >= 4) seal(bytes);
    return bytes;
  }
  static constexpr uint8_t kUnits[] = {4, 4, 1, 3};
  vm::Image image;
  image.unit = kUnits[kind / 8 % 4];
  if (kind % 8 == 1)
    while (choices.left() >= 4) image.code.push_back(choices.u32());
  else
    image.code = valid_code(choices, image.unit == 4 ? UnitShape{} : UnitShape{512, 2});
  if (kind % 8 == 2) image.unit = in.u8() % 8;
  if (kind & 32) image.symbols = {{"a", in.u16(), 1}, {"abc", in.u16(), static_cast<uint16_t>(in.u8())}};
  if (kind & 64) image.functions = {{"main", 0}};
  bytes = vm::write_image(image);
  valid = kind % 8 > 3 && (kind & 32) == 0;
  if (kind % 8 != 3) return bytes;
  for (int changes = in.u8() % 4; changes > 0; --changes) bytes[in.u16() % bytes.size()] = in.u8();
  bytes.resize(bytes.size() + in.u8() % 4 - in.u8() % 4);
  if (in.u8() % 8 != 0) seal(bytes);
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  Session session({data, size});
  Input& in = session.in;
  bool valid = false;
  const std::vector<uint8_t> bytes = make_image(in, valid);
  const uint8_t memory = in.u8();
  const uint8_t twist = in.u8();
  const Memory image(bytes.size(), twist == 1 ? 1 : 0);
  if (!bytes.empty()) std::memcpy(image.at(), bytes.data(), bytes.size());

  const size_t program_size = ipos_program_size() - (twist == 2 ? 1 : 0);
  const Memory program_memory(program_size, twist == 3 ? 4 : 0);
  ipos_trouble trouble{};
  const ipos_status loaded = known(ipos_program_load(
      twist == 4 ? nullptr : program_memory.at(), program_size, twist == 5 ? nullptr : image.at(),
      bytes.size(), twist == 6 ? nullptr : &session.program, twist == 7 ? nullptr : &trouble));
  require((loaded == IPOS_OK) == (session.program != nullptr), "a refused image gives no program");
  require(loaded == IPOS_OK || !valid || (twist >= 1 && twist <= 7),
          "the verifier accepts every valid program");
  if (loaded != IPOS_OK) {
    require(twist == 7 || trouble.offset <= bytes.size(), "trouble is in the image");
    return 0;
  }
  known(ipos_program_info_of(session.program, &session.info));

  size_t fast_size = ipos_accelerate_size(session.program);
  if (twist == 8 && fast_size != 0) --fast_size;
  const Memory fast(fast_size, twist == 9 ? 4 : 0);
  const auto accelerate = [&] { known(ipos_program_accelerate(session.program, fast.at(), fast_size)); };
  if (memory & 1) accelerate();
  const uint8_t stations = 1 + memory / 4 % 3;
  for (uint8_t n = 0; n < stations; ++n) {
    session.stations.push_back(std::make_unique<Station>(session));
    init(*session.stations.back(), 0);
    known(ipos_start(session.stations.back()->vm));
    if (n == 0 && (memory & 3) == 2) accelerate();  // the first machine goes on without
  }
  for (int n = 0; n < kMostCalls && !in.empty(); ++n) call(session, nullptr);
  return 0;
}
