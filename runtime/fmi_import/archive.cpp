// The central directory decides; a local header is only asked where the bytes begin.
#include "runtime/fmi_import/archive.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <set>

#include "stdlib/plain_text.hpp"

namespace ipos::fmi_import {
namespace {

namespace fs = std::filesystem;

// Sizes and marks of APPNOTE.TXT 4.3.7, 4.3.12, 4.3.16.
constexpr std::string_view kLocal{"PK\3\4", 4}, kCentral{"PK\1\2", 4}, kEnd{"PK\5\6", 4};
constexpr size_t kLocalSize = 30, kCentralSize = 46, kEndSize = 22, kLongestComment = 65'535;
constexpr uint16_t kStored = 0, kDeflated = 8, kEncrypted = 1;
constexpr size_t kLongestName = 1'000;  // ours

uint32_t number(std::string_view bytes, size_t at, size_t size) {
  uint32_t value = 0;
  for (size_t n = size; n-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes[at + n]);
  return value;
}

// Relative, without a step up, and the same on every system.
bool stays_below(std::string_view name) {
  if (name.empty() || name.front() == '/' || name.size() > kLongestName || !stdlib::is_plain(name) ||
      name.find_first_of("\\:") != std::string_view::npos)
    return false;
  for (size_t begin = 0; begin <= name.size();) {
    const size_t end = std::min(name.find('/', begin), name.size());
    const std::string_view part = name.substr(begin, end - begin);
    if (part == ".." || part == "." || (part.empty() && end != name.size())) return false;
    begin = end + 1;
  }
  return true;
}

std::string_view::size_type find_end(std::string_view bytes) {
  if (bytes.size() < kEndSize) return std::string_view::npos;
  const size_t first = bytes.size() - std::min(bytes.size(), kEndSize + kLongestComment);
  for (size_t at = bytes.size() - kEndSize; at + 1 > first; --at) {
    if (bytes.substr(at, 4) == kEnd && at + kEndSize + number(bytes, at + 20, 2) == bytes.size()) return at;
    if (at == 0) break;
  }
  return std::string_view::npos;
}

tl::expected<std::string, std::string> inflated(std::string_view packed, size_t size) {
  std::string out(size, '\0');
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return tl::unexpected(std::string("cannot be unpacked"));
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int result = inflate(&stream, Z_FINISH);
  const bool whole = result == Z_STREAM_END && stream.avail_out == 0;
  inflateEnd(&stream);
  if (!whole) return tl::unexpected(std::string("is damaged"));
  return out;
}

bool write_new(const fs::path& path, std::string_view bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0700);
  if (file < 0) return false;
  bool good = true;
  while (good && !bytes.empty()) {
    const ssize_t done = ::write(file, bytes.data(), bytes.size());
    good = done > 0;
    if (good) bytes.remove_prefix(static_cast<size_t>(done));
  }
  return ::close(file) == 0 && good;
}

}  // namespace

tl::expected<Archive, std::string> Archive::open(std::string bytes) {
  const auto refuse = [](std::string why) { return tl::unexpected(std::move(why)); };
  const size_t end = find_end(bytes);
  if (end == std::string::npos) return refuse("is no zip archive");
  const std::string_view all = bytes;
  const uint32_t count = number(all, end + 10, 2);
  size_t at = number(all, end + 16, 4);
  if (at == UINT32_MAX || count == UINT16_MAX) return refuse("is a zip64 archive, which ipos does not read");
  if (number(all, end + 4, 4) != 0) return refuse("is one part of an archive of several files");
  if (count > kMostFiles) return refuse(fmt::format("has more than {} files", kMostFiles));
  Archive archive;
  uint64_t sum = 0;
  std::set<std::string> names;
  for (uint32_t n = 0; n < count; ++n) {
    if (at > end || end - at < kCentralSize || all.substr(at, 4) != kCentral) return refuse("has a damaged directory");
    const size_t name_size = number(all, at + 28, 2);
    const size_t size = kCentralSize + name_size + number(all, at + 30, 2) + number(all, at + 32, 2);
    if (end - at < size) return refuse("has a damaged directory");
    Entry entry{std::string(all.substr(at + kCentralSize, name_size)),
                static_cast<uint16_t>(number(all, at + 10, 2)),
                number(all, at + 16, 4),
                number(all, at + 20, 4),
                number(all, at + 24, 4),
                number(all, at + 42, 4)};
    const uint32_t flags = number(all, at + 8, 2);
    at += size;
    if (!stays_below(entry.name)) return refuse("has a file whose name leads out of its folder");
    if (!names.insert(entry.name).second) return refuse(fmt::format("has two files '{}'", entry.name));
    if ((flags & kEncrypted) != 0) return refuse("is encrypted");
    if (entry.method != kStored && entry.method != kDeflated)
      return refuse(fmt::format("has '{}' packed in a way that ipos does not read", entry.name));
    sum += entry.size;
    if (sum > kMostBytes) return refuse(fmt::format("has more than {} MB unpacked", kMostBytes >> 20U));
    if (entry.name.back() != '/') archive.entries_.push_back(std::move(entry));
  }
  archive.bytes_ = std::move(bytes);
  return archive;
}

const Archive::Entry* Archive::find(std::string_view name) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [name](const Entry& entry) { return entry.name == name; });
  return found == entries_.end() ? nullptr : &*found;
}

tl::expected<std::string, std::string> Archive::bytes_of(const Entry& entry) const {
  const std::string_view all = bytes_;
  const auto damaged = [&] { return tl::unexpected(fmt::format("'{}' is damaged", entry.name)); };
  if (entry.offset > all.size() || all.size() - entry.offset < kLocalSize || all.substr(entry.offset, 4) != kLocal)
    return damaged();
  const size_t begin = size_t{entry.offset} + kLocalSize + number(all, entry.offset + 26, 2) + number(all, entry.offset + 28, 2);
  if (begin > all.size() || all.size() - begin < entry.packed) return damaged();
  const std::string_view packed = all.substr(begin, entry.packed);
  std::string bytes;
  if (entry.method == kStored) {
    if (entry.packed != entry.size) return damaged();
    bytes = packed;
  } else if (auto unpacked = inflated(packed, entry.size)) {
    bytes = *std::move(unpacked);
  } else {
    return damaged();
  }
  const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
  if (sum != entry.crc) return damaged();
  return bytes;
}

tl::expected<std::string, std::string> Archive::read(std::string_view name, uint64_t most) const {
  const Entry* entry = find(name);
  if (entry == nullptr) return tl::unexpected(fmt::format("has no {}", name));
  if (entry->size > most) return tl::unexpected(fmt::format("has a {} of more than {} MB", name, most >> 20U));
  return bytes_of(*entry);
}

tl::expected<void, std::string> Archive::unpack(std::string_view prefix, const fs::path& folder) const {
  for (const Entry& entry : entries_) {
    if (!entry.name.starts_with(prefix)) continue;
    const auto bytes = bytes_of(entry);
    if (!bytes) return tl::unexpected(bytes.error());
    const fs::path path = folder / entry.name;
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error || !write_new(path, *bytes))
      return tl::unexpected(fmt::format("'{}' cannot be written to {}", entry.name, folder.string()));
  }
  return {};
}

}  // namespace ipos::fmi_import
