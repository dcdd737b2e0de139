// The blocks of a file `.ipos-trace`: what surrounds the columns. Each block is whole or it is not there, so a run that was
// killed leaves all before the last one. docs/reference/trace-file.md has the table of the bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "tools/packing/pack.hpp"

namespace ipos::tools {

// Not text on purpose: a transfer that changes ends of lines breaks it (as PNG's).
inline constexpr std::string_view kTraceMagic{"\x89IPOStrc\r\n\x1a\n", 12};
inline constexpr uint8_t kTraceVersion = 1;

enum class BlockKind : uint8_t { Head = 'H', Rows = 'R', End = 'E' };

// Of the content of a block, as it is unpacked (ours).
inline constexpr size_t kMostContent = size_t{1} << 28U;

class BlockWriter {
 public:
  explicit BlockWriter(std::ostream& out);
  // A Failure where the content is larger than a block may be.
  void write(BlockKind kind, std::string_view content);

 private:
  std::ostream& out_;
  Packer packer_;
  std::string block_;  // kept, so that its memory is
};

struct TraceMistake {
  size_t offset;  // of the block in the file
  std::string text;
};

class BlockReader {
 public:
  struct Block {
    size_t offset;
    BlockKind kind;
    std::string_view content;  // until the next block is read
  };

  explicit BlockReader(std::string_view bytes) : bytes_(bytes) {}
  // Whether it is such a file, of a version that is known.
  std::optional<TraceMistake> begin();
  // The next block; nothing behind the last whole one.
  tl::expected<std::optional<Block>, TraceMistake> next();
  // Where the file ends within a block or without its last one: the run that wrote it was killed, or still writes.
  std::optional<size_t> ends_early() const { return ends_early_; }

 private:
  std::string_view bytes_;
  size_t at_ = 0;
  bool over_ = false;
  std::optional<size_t> ends_early_;
  std::string unpacked_;
};

}  // namespace ipos::tools
