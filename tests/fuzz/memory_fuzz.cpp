// Any bytes as the memory file of a unit, and as a payload whose checksum is right: refused, or a content
// that has exactly one coding and survives a store.
#include <algorithm>
#include <vector>

#include "runtime/nv_memory/medium/slot_store.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace ipos::runtime;  // NOLINT
using namespace ipos::tests;    // NOLINT

namespace {

class Medium final : public NvMedium {
 public:
  explicit Medium(std::span<const uint8_t> found) : bytes_(found.begin(), found.end()) {}
  tl::expected<size_t, std::string> read(uint64_t offset, std::span<uint8_t> out) override {
    if (offset >= bytes_.size()) return 0;
    const size_t n = std::min<size_t>(out.size(), bytes_.size() - offset);
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), n, out.begin());
    return n;
  }
  std::optional<std::string> write(uint64_t offset, std::span<const uint8_t> in) override {
    bytes_.resize(std::max<size_t>(bytes_.size(), offset + in.size()));
    std::copy(in.begin(), in.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(offset));
    return std::nullopt;
  }
  std::optional<std::string> sync() override { return std::nullopt; }

 private:
  std::vector<uint8_t> bytes_;
};

void survives(NvMedium& medium, const NvContent& content) {
  SlotStore store(medium, 1);
  if (const NvOutcome found = store.load().outcome; found == NvOutcome::Refused) return;
  require(!store.save(content), "a content that was read can be stored");
  const NvLoad again = SlotStore(medium, 1).load();
  require(again.outcome == NvOutcome::Loaded && again.content == content, "what is stored is found");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  Medium medium({data, size});
  const NvLoad loaded = SlotStore(medium, 1).load();
  require(loaded.outcome != NvOutcome::Failed, "a medium that can be read does not fail");
  const bool told = loaded.outcome == NvOutcome::Damaged || loaded.outcome == NvOutcome::Refused;
  require(!told || !loaded.text.empty(), "damage and refusal are told");
  survives(medium, loaded.content);

  if (const auto content = decode_content({data, size})) {
    const std::vector<uint8_t> bytes = encode(*content);
    require(std::equal(bytes.begin(), bytes.end(), data, data + size), "a content has one coding");
    Medium empty({});
    survives(empty, *content);
  }
  return 0;
}
