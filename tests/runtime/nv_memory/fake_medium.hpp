// A medium in memory that records its writes, so that a test can build what a power cut at any byte of any of
// them would have left, and that fails on demand.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "runtime/nv_memory/medium/nv_medium.hpp"

namespace ipos::tests {

struct MediumWrite {
  uint64_t offset;
  std::vector<uint8_t> bytes;
};

using MediumBytes = std::vector<uint8_t>;

inline void put_bytes(MediumBytes& image, uint64_t offset, std::span<const uint8_t> bytes) {
  if (bytes.empty()) return;
  if (image.size() < offset + bytes.size()) image.resize(offset + bytes.size());
  std::copy(bytes.begin(), bytes.end(), image.begin() + static_cast<std::ptrdiff_t>(offset));
}

struct MediumState {
  MediumBytes bytes;
  std::vector<MediumWrite> writes;  // since the last clear
  int syncs = 0;
  // After so many more bytes the medium is full; -1: never.
  int64_t room = -1;
  bool sync_fails = false;
  bool read_fails = false;
};

// Several media can share a state: the file that is closed and opened again.
class FakeMedium final : public runtime::NvMedium {
 public:
  explicit FakeMedium(std::shared_ptr<MediumState> state) : state_(std::move(state)) {}

  tl::expected<size_t, std::string> read(uint64_t offset, std::span<uint8_t> out) override {
    if (state_->read_fails) return tl::unexpected(std::string("read error"));
    if (offset >= state_->bytes.size()) return 0;
    const size_t n = std::min<size_t>(out.size(), state_->bytes.size() - offset);
    std::copy_n(state_->bytes.begin() + static_cast<std::ptrdiff_t>(offset), n, out.begin());
    return n;
  }

  std::optional<std::string> write(uint64_t offset, std::span<const uint8_t> bytes) override {
    size_t n = bytes.size();
    if (state_->room >= 0) n = std::min(n, static_cast<size_t>(state_->room));
    if (state_->room >= 0) state_->room -= static_cast<int64_t>(n);
    put_bytes(state_->bytes, offset, bytes.first(n));
    state_->writes.push_back({offset, {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n)}});
    if (n < bytes.size()) return "no space left";
    return std::nullopt;
  }

  std::optional<std::string> sync() override {
    ++state_->syncs;
    if (state_->sync_fails) return "input/output error";
    return std::nullopt;
  }

 private:
  std::shared_ptr<MediumState> state_;
};

// What is found after a power cut.
class FoundMedium final : public runtime::NvMedium {
 public:
  explicit FoundMedium(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  tl::expected<size_t, std::string> read(uint64_t offset, std::span<uint8_t> out) override {
    if (offset >= bytes_.size()) return 0;
    const size_t n = std::min<size_t>(out.size(), bytes_.size() - offset);
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), n, out.begin());
    return n;
  }
  std::optional<std::string> write(uint64_t, std::span<const uint8_t>) override { return "read only"; }
  std::optional<std::string> sync() override { return "read only"; }

 private:
  std::span<const uint8_t> bytes_;
};

}  // namespace ipos::tests
