// The files of an FMU: a zip archive in memory, of which a stranger may have made every byte. Stored and deflated files, no zip64,
// no encryption; names stay below the folder that they are unpacked to, and sizes are bounded before anything is unpacked.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace ipos::fmi_import {

class Archive {
 public:
  static constexpr size_t kMostFiles = 20'000;                // ours, as the others
  static constexpr uint64_t kMostBytes = uint64_t{2} << 30U;  // of all files unpacked

  // The list of its files; the error says what is wrong with it.
  static tl::expected<Archive, std::string> open(std::string bytes);

  bool has(std::string_view name) const { return find(name) != nullptr; }
  tl::expected<std::string, std::string> read(std::string_view name, uint64_t most) const;

  // Writes the files whose names begin so; nothing of the folder may be there yet. The error names the file.
  tl::expected<void, std::string> unpack(std::string_view prefix, const std::filesystem::path& folder) const;

 private:
  struct Entry {
    std::string name;
    uint16_t method = 0;
    uint32_t crc = 0;
    uint32_t packed = 0;
    uint32_t size = 0;
    uint32_t offset = 0;  // of its local header
  };
  const Entry* find(std::string_view name) const;
  tl::expected<std::string, std::string> bytes_of(const Entry& entry) const;

  std::string bytes_;
  std::vector<Entry> entries_;
};

}  // namespace ipos::fmi_import
