// States of an instance: kept, brought back, and as bytes.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "runtime/fmi/instance.hpp"
#include "vm/image/view.hpp"

namespace ipos::fmi {
namespace {

constexpr std::string_view kHead = "iposfmu\2";  // the last is the version

void put(std::string& out, uint64_t number) {
  for (int n = 0; n < 8; ++n) out += static_cast<char>(number >> (8 * n));
}
uint64_t take(std::string_view& bytes) {
  uint64_t number = 0;
  for (size_t n = 0; n < 8; ++n) number |= uint64_t{static_cast<uint8_t>(bytes[n])} << (8 * n);
  bytes.remove_prefix(8);
  return number;
}
void put_text(std::string& out, std::string_view text) {
  put(out, text.size());
  out += text;
}
// What is not there any more is nothing.
uint64_t take_number(std::string_view& bytes) {
  if (bytes.size() >= 8) return take(bytes);
  bytes = {};
  return 0;
}
std::string take_text(std::string_view& bytes) {
  const uint64_t size = std::min<uint64_t>(take_number(bytes), bytes.size());
  std::string text(bytes.substr(0, size));
  bytes.remove_prefix(size);
  return text;
}
uint64_t sum_of(std::string_view bytes) {
  return vm::crc32({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

}  // namespace

std::unique_ptr<SavedInstance> Instance::save() const {
  auto saved = std::make_unique<SavedInstance>();
  saved->stage = static_cast<uint8_t>(stage_);
  saved->start = start_;
  saved->time = time_;
  saved->plant = session_->save();
  for (const auto& terminal : terminals_) saved->terminals.push_back(terminal->buffers);
  return saved;
}

// The plant does again what was done to it, unless it stands there already.
Status Instance::restore(const SavedInstance& saved) {
  if (session_->save() != saved.plant) {
    std::string why;
    if (session_->restore(saved.plant, why) != library::Session::Restored::Done) return fail(why);
    told_ = std::as_const(*session_).plant().journal().entries().size();
    if (const auto missing = find_variables()) return fail(*missing);
    for (const auto& terminal : terminals_) terminal->forget_heard(*session_);
  }
  for (size_t n = 0; n < terminals_.size() && n < saved.terminals.size(); ++n) {
    terminals_[n]->buffers = saved.terminals[n];
    terminals_[n]->announced.reset();
  }
  stage_ = static_cast<Stage>(saved.stage);
  start_ = saved.start;
  time_ = saved.time;
  return Status::Ok;
}

std::string Instance::to_bytes(const SavedInstance& saved) const {
  std::string out(kHead);
  put(out, sum_of(token_));
  put(out, saved.stage);
  put(out, std::bit_cast<uint64_t>(saved.start));
  put(out, std::bit_cast<uint64_t>(saved.time));
  put(out, saved.terminals.size());
  for (const TerminalBuffers& terminal : saved.terminals) {
    put_text(out, terminal.out);
    put_text(out, terminal.in);
    put(out, terminal.rx_active ? 1 : 0);
    put(out, terminal.notified ? 1 : 0);
    put(out, terminal.sent.size());
    for (const auto& [id, operation] : terminal.sent) {
      put(out, id);
      put_text(out, operation);
    }
  }
  out.append(saved.plant.begin(), saved.plant.end());
  put(out, sum_of(out));
  return out;
}

std::unique_ptr<SavedInstance> Instance::from_bytes(std::string_view bytes) {
  const auto refuse = [&](const std::string& why) {
    fail(why);
    return nullptr;
  };
  constexpr size_t kNumbers = 6 * 8;
  if (bytes.size() < kHead.size() + kNumbers || !bytes.starts_with(kHead)) return refuse("these bytes are no state of an FMU of ipos");
  std::string_view sum = bytes.substr(bytes.size() - 8);
  bytes.remove_suffix(8);
  if (take(sum) != sum_of(bytes)) return refuse("the saved state is damaged: its checksum is wrong");
  bytes.remove_prefix(kHead.size());
  if (take(bytes) != sum_of(token_)) return refuse("the state was saved by another FMU");
  auto saved = std::make_unique<SavedInstance>();
  const uint64_t stage = take(bytes);
  saved->stage = static_cast<uint8_t>(stage);
  saved->start = std::bit_cast<double>(take(bytes));
  saved->time = std::bit_cast<double>(take(bytes));
  if (stage > static_cast<uint64_t>(Stage::Terminated) || !std::isfinite(saved->start) || !std::isfinite(saved->time))
    return refuse("the saved state is damaged: it makes no sense");
  const uint64_t terminals = take_number(bytes);
  if (terminals != terminals_.size()) return refuse("the saved state is damaged: it has other terminals");
  for (uint64_t n = 0; n < terminals; ++n) {
    TerminalBuffers& terminal = saved->terminals.emplace_back();
    terminal.out = take_text(bytes);
    terminal.in = take_text(bytes);
    terminal.rx_active = take_number(bytes) != 0;
    terminal.notified = take_number(bytes) != 0;
    for (uint64_t left = take_number(bytes); left != 0 && !bytes.empty(); --left) {
      const auto id = static_cast<uint32_t>(take_number(bytes));
      terminal.sent[id] = take_text(bytes);
    }
  }
  saved->plant.assign(bytes.begin(), bytes.end());
  return saved;
}

}  // namespace ipos::fmi
