// ipos_fuzz_seeds FOLDER SOURCE...: makes seeds of programs: FOLDER/frontend is their text, FOLDER/assembler,
// image and execution are what the compiler makes of it, so that they follow the coding of commands and
// images.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "compiler/asm/disassembler.hpp"
#include "compiler/compile.hpp"
#include "vm/image/image.hpp"

namespace fs = std::filesystem;
using namespace ipos;  // NOLINT

namespace {

void write(const fs::path& file, std::string_view bytes) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

int main(int argc, char** argv) {
  int written = 0;
  for (int i = 2; i < argc; ++i) {
    std::ifstream in(argv[i], std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const compiler::Compilation made = compiler::compile("seed.IPC", "", text);
    const fs::path folder = argv[1];
    const fs::path source = argv[i];
    const std::string name = source.parent_path().filename().string() + "-" + source.stem().string();
    write(folder / "frontend" / (name + ".IPC"), text);
    if (!made.image) continue;
    const std::vector<uint8_t> bytes = vm::write_image(*made.image);
    const std::string image(bytes.begin(), bytes.end());
    std::string words;
    for (const uint32_t word : made.image->code)
      for (int shift = 0; shift < 32; shift += 8) words += static_cast<char>(word >> shift & 0xFF);
    write(folder / "image" / (name + ".ipx"), image);
    write(folder / "execution" / (name + ".image"), std::string(2, '\0') + image);
    write(folder / "execution" / (name + ".words"), std::string("\x01\x01", 2) + words);
    write(folder / "assembler" / (name + ".asm"), compiler::disassemble(*made.image));
    ++written;
  }
  std::printf("seeds of %d programs\n", written);
  return written != 0 ? 0 : 1;
}
