// Reads documentation pages: fenced blocks with the line of prose before them, and their compilation.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ipos::tests {

struct Block {
  std::string language;  // behind the opening fence
  std::string heading;   // the last line of prose before it, "Wrong:" and the like
  std::string options;   // of `<!-- ipos: ... -->` right before it
  std::string text;
};

std::vector<Block> blocks_of(const std::string& page);

struct Compiled {
  std::vector<std::string> codes;  // of all messages, in their order
  std::string messages;            // as the user reads them
  bool good = false;               // no errors
};

// Compiles a block of ```ipc or ```ipa as MAIN.IPC or MAIN.ipa. Options: `--unit NAME`, `-WNAME`, `encode as
// UTF-16`.
// The files level1.h to level100.h are at hand: each includes the next.
Compiled compile_block(const Block& block);

}  // namespace ipos::tests
