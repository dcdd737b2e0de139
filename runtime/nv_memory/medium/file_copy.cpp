// The copy, and how it is read while another run may be writing.
#include "runtime/nv_memory/medium/file_copy.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "runtime/nv_memory/medium/slot_store.hpp"

namespace ipos::runtime {
namespace {

// What is written to it nobody sees.
class CopyMedium final : public NvMedium {
 public:
  explicit CopyMedium(std::vector<uint8_t> bytes) : bytes_(std::move(bytes)) {}

  tl::expected<size_t, std::string> read(uint64_t offset, std::span<uint8_t> out) override {
    const auto first = static_cast<size_t>(std::min<uint64_t>(offset, bytes_.size()));
    const size_t count = std::min(out.size(), bytes_.size() - first);
    std::copy_n(bytes_.begin() + static_cast<ptrdiff_t>(first), count, out.begin());
    return count;
  }
  std::optional<std::string> write(uint64_t offset, std::span<const uint8_t> bytes) override {
    const auto first = static_cast<size_t>(offset);
    if (bytes_.size() < first + bytes.size()) bytes_.resize(first + bytes.size());
    std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<ptrdiff_t>(first));
    return std::nullopt;
  }
  std::optional<std::string> sync() override { return std::nullopt; }

 private:
  std::vector<uint8_t> bytes_;
};

}  // namespace

// Another run may be writing: two equal readings are of one state. It stores once a millisecond at most.
tl::expected<std::unique_ptr<NvMedium>, std::string> copy_of(NvMedium& file) {
  constexpr int kTries = 100;
  std::vector<uint8_t> last;
  for (int tries = 0; tries < kTries; ++tries) {
    std::vector<uint8_t> bytes(2 * kSlotStride);
    const auto count = file.read(0, bytes);
    if (!count) return tl::unexpected(count.error());
    bytes.resize(*count);
    if (tries != 0 && bytes == last) return std::make_unique<CopyMedium>(std::move(bytes));
    last = std::move(bytes);
  }
  return tl::unexpected(std::string("another run is writing it all the time"));
}

std::unique_ptr<NvMedium> copy_of_nothing() { return std::make_unique<CopyMedium>(std::vector<uint8_t>()); }

}  // namespace ipos::runtime
