// Bytes: a head, a row a action, a CRC-32 over all.
#include "runtime/library/action.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "vm/image/view.hpp"

namespace ipos::library {
namespace {

constexpr std::array<uint8_t, 8> kMagic = {'i', 'p', 'o', 's', 'r', 'u', 'n', 1};  // the last is the version
constexpr size_t kChecksumBytes = 4;

class Writer {
 public:
  void number(uint64_t value, size_t bytes) {
    for (size_t n = 0; n < bytes; ++n) out.push_back(static_cast<uint8_t>(value >> (8 * n)));
  }
  void text(std::span<const uint8_t> bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); }
  std::vector<uint8_t> out;
};

class Reader {
 public:
  explicit Reader(std::span<const uint8_t> bytes) : rest_(bytes) {}
  uint64_t number(size_t bytes) {
    uint64_t value = 0;
    const auto part = take(bytes);
    for (size_t n = 0; n < part.size(); ++n) value |= uint64_t{part[n]} << (8 * n);
    return value;
  }
  std::span<const uint8_t> take(size_t bytes) {
    if (bytes > rest_.size()) {
      failed_ = true;
      return {};
    }
    const auto part = rest_.first(bytes);
    rest_ = rest_.subspan(bytes);
    return part;
  }
  bool failed() const { return failed_; }
  bool at_end() const { return rest_.empty(); }

 private:
  std::span<const uint8_t> rest_;
  bool failed_ = false;
};

Action read_deed(Reader& in) {
  Action action;
  action.at = static_cast<runtime::Time>(in.number(8));
  action.act = static_cast<Act>(in.number(1));
  action.signal.kind = static_cast<Kind>(in.number(1));
  action.signal.station = static_cast<uint32_t>(in.number(4));
  action.signal.number = static_cast<uint32_t>(in.number(4));
  action.number = static_cast<uint32_t>(in.number(4));
  action.value = static_cast<int64_t>(in.number(8));
  const auto bytes = in.take(static_cast<size_t>(in.number(4)));
  action.bytes.assign(bytes.begin(), bytes.end());
  return action;
}

}  // namespace

std::vector<uint8_t> to_bytes(uint64_t identity, runtime::Time time, uint64_t digest,
                              std::span<const Action> actions) {
  Writer out;
  out.text(kMagic);
  out.number(identity, 8);
  out.number(static_cast<uint64_t>(time), 8);
  out.number(digest, 8);
  out.number(actions.size(), 8);
  for (const Action& action : actions) {
    out.number(static_cast<uint64_t>(action.at), 8);
    out.number(static_cast<uint64_t>(action.act), 1);
    out.number(static_cast<uint64_t>(action.signal.kind), 1);
    out.number(action.signal.station, 4);
    out.number(action.signal.number, 4);
    out.number(action.number, 4);
    out.number(static_cast<uint64_t>(action.value), 8);
    out.number(action.bytes.size(), 4);
    out.text(action.bytes);
  }
  out.number(vm::crc32(out.out), kChecksumBytes);
  return std::move(out.out);
}

tl::expected<SavedState, std::string> from_bytes(std::span<const uint8_t> bytes) {
  if (bytes.size() < kMagic.size() + kChecksumBytes ||
      !std::equal(kMagic.begin(), kMagic.end(), bytes.begin()))
    return tl::unexpected(std::string("these bytes are no saved state of this version"));
  const auto content = bytes.first(bytes.size() - kChecksumBytes);
  if (vm::crc32(content) != Reader(bytes.last(kChecksumBytes)).number(kChecksumBytes))
    return tl::unexpected(std::string("the saved state is damaged: its checksum is wrong"));
  Reader in(content.subspan(kMagic.size()));
  SavedState saved;
  saved.identity = in.number(8);
  saved.time = static_cast<runtime::Time>(in.number(8));
  saved.digest = in.number(8);
  const uint64_t count = in.number(8);
  runtime::Time last = 0;
  for (uint64_t n = 0; n < count && !in.failed(); ++n) {
    saved.actions.push_back(read_deed(in));
    const Action& action = saved.actions.back();
    if (action.at < last || action.at > saved.time || action.act > kLastAct || action.signal.kind == Kind::Signal || action.signal.kind > kLastKind)
      return tl::unexpected(std::string("the saved state is damaged: what was done makes no sense"));
    last = action.at;
  }
  if (in.failed() || !in.at_end() || saved.time < 0 || saved.time == runtime::kNever)
    return tl::unexpected(std::string("the saved state is damaged: its length is wrong"));
  return saved;
}

}  // namespace ipos::library
