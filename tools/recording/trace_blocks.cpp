// A block: kind, packing, two zeros, length of what follows, length of its content as it is unpacked; the content, packed or not;
// CRC-32 of all that.
#include "tools/recording/trace_blocks.hpp"

#include <fmt/format.h>

#include <array>

#include "tools/cli/failure.hpp"
#include "tools/packing/unpack.hpp"
#include "vm/image/view.hpp"

namespace ipos::tools {
namespace {

enum class BlockPacking : uint8_t { Stored = 0, Zlib = 1 };

constexpr size_t kLengthAt = 4, kContentAt = 8, kHeader = 12, kChecksum = 4;

void put_u32(std::string& out, uint32_t value) {
  for (size_t n = 0; n < 4; ++n) out += static_cast<char>(value >> 8 * n);
}
uint32_t u32_at(std::string_view bytes, size_t at) {
  uint32_t value = 0;
  for (size_t n = 4; n-- > 0;) value = value << 8 | static_cast<uint8_t>(bytes[at + n]);
  return value;
}

uint32_t checksum(std::string_view block) {
  return vm::crc32({reinterpret_cast<const uint8_t*>(block.data()), block.size()});
}

}  // namespace

BlockWriter::BlockWriter(std::ostream& out) : out_(out) {
  out_.write(kTraceMagic.data(), static_cast<std::streamsize>(kTraceMagic.size()));
  const std::array<char, 4> version{static_cast<char>(kTraceVersion)};
  out_.write(version.data(), version.size());
}

void BlockWriter::write(BlockKind kind, std::string_view content) {
  if (content.size() > kMostContent)
    throw Failure(kBadInput, fmt::format("the trace has {} MiB in a tenth of a second, more than a block of its form may have; choose fewer signals",
                                         content.size() >> 20U));
  const std::string_view packed = packer_.pack(content);
  const std::string_view body = packed.empty() ? content : packed;
  block_.assign({static_cast<char>(kind), static_cast<char>(packed.empty() ? BlockPacking::Stored : BlockPacking::Zlib), 0, 0});
  put_u32(block_, static_cast<uint32_t>(body.size()));
  put_u32(block_, static_cast<uint32_t>(content.size()));
  block_ += body;
  put_u32(block_, checksum(block_));
  out_.write(block_.data(), static_cast<std::streamsize>(block_.size()));
}

std::optional<TraceMistake> BlockReader::begin() {
  if (!bytes_.starts_with(kTraceMagic)) return TraceMistake{0, "this is no .ipos-trace"};
  at_ = kTraceMagic.size() + 4;
  if (bytes_.size() < at_) return TraceMistake{bytes_.size(), "the file ends within its first bytes"};
  const uint32_t version = u32_at(bytes_, kTraceMagic.size());
  if (version != kTraceVersion)
    return TraceMistake{kTraceMagic.size(), fmt::format("the trace is of version {}, and this ipos reads version {}", version, kTraceVersion)};
  return std::nullopt;
}

tl::expected<std::optional<BlockReader::Block>, TraceMistake> BlockReader::next() {
  const std::string_view rest = bytes_.substr(at_);
  const auto wrong = [&](std::string text) { return tl::unexpected(TraceMistake{at_, std::move(text)}); };
  if (over_) {
    if (!rest.empty()) return wrong(fmt::format("{} bytes stand behind the last block", rest.size()));
    return std::nullopt;
  }
  const size_t length = rest.size() < kHeader ? 0 : u32_at(rest, kLengthAt);
  if (rest.size() < kHeader + kChecksum || rest.size() - kHeader - kChecksum < length) {
    ends_early_ = at_;
    return std::nullopt;
  }
  const std::string_view body = rest.substr(kHeader, length);
  if (checksum(rest.substr(0, kHeader + length)) != u32_at(rest, kHeader + length)) return wrong("the block is damaged: its checksum differs");
  const auto kind = static_cast<BlockKind>(rest[0]);
  if (kind != BlockKind::Head && kind != BlockKind::Rows && kind != BlockKind::End)
    return wrong(fmt::format("the block is of the unknown kind {}", static_cast<uint8_t>(rest[0])));
  const size_t size = u32_at(rest, kContentAt);
  if (size > kMostContent) return wrong(fmt::format("the block says that it has {} bytes, more than it may have", size));
  Block block{at_, kind, body};
  switch (static_cast<BlockPacking>(rest[1])) {
    case BlockPacking::Stored:
      if (length != size) return wrong("the two lengths of a block that is not packed differ");
      break;
    case BlockPacking::Zlib: {
      if (!has_zlib()) return wrong("the block is packed, and this build of ipos has no zlib");
      unpacked_.clear();
      const auto take = [&](std::string_view piece) {
        unpacked_ += piece;
        return unpacked_.size() <= size;
      };
      if (unpack(body, Packing::Zlib, take) != Unpacked::Whole || unpacked_.size() != size)
        return wrong("what is packed in the block cannot be unpacked to the length that it says");
      block.content = unpacked_;
      break;
    }
    default: return wrong(fmt::format("the block is packed in the unknown way {}", static_cast<uint8_t>(rest[1])));
  }
  over_ = kind == BlockKind::End;
  at_ += kHeader + length + kChecksum;
  return block;
}

}  // namespace ipos::tools
