// ipos_fuzz_seeds FOLDER SOURCE...: makes seeds of programs: FOLDER/frontend is their text, FOLDER/assembler,
// image and execution are what the compiler makes of it, so that they follow the coding of commands and
// images. FOLDER/assembler.dict has the words of the assembler, for libFuzzer.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "compiler/asm/disassembler.hpp"
#include "compiler/compile.hpp"
#include "vm/image/image.hpp"
#include "vm/isa/isa.hpp"

namespace fs = std::filesystem;
using namespace ipos;  // NOLINT

namespace {

void write(const fs::path& file, std::string_view bytes) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

// A word of a dictionary, in quotes.
std::string word(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    c == '\n' ? out += "\\x0a" : out += c;
  }
  return out + "\"\n";
}

// A command with plain operands, so that an input grows by a whole line.
std::string line_of(const vm::OpcodeInfo& row) {
  std::string out;
  for (size_t at = 0, operand = 0; at < row.text.size(); ++at) {
    if (row.text[at] != '{') {
      out += row.text[at];
      continue;
    }
    at = row.text.find('}', at);
    const vm::OperandInfo& info = row.operands[operand++];
    switch (info.kind) {
      case vm::OperandKind::Variable: out += "H1"; break;
      case vm::OperandKind::Label: out += "@0"; break;
      case vm::OperandKind::Keyword: out += vm::find_keyword(info.keyword_set, 1)->text; break;
      default: out += '1';
    }
  }
  return out + '\n';
}

std::string assembler_words() {
  std::string out;
  for (const vm::OpcodeInfo& row : vm::opcode_table()) out += word(line_of(row));
  for (const vm::KeywordInfo& row : vm::keyword_table()) out += word(row.text);
  for (const std::string_view text : {".unit mdxb\n",
                                      ".unit 1\n",
                                      ".file \"a\"\n",
                                      ".symbol H1 a 2\n",
                                      ".function a @0\n",
                                      ".line @0 0 1 1\n",
                                      ".line 0 1 1\n",
                                      "WORD 1\n",
                                      "REM ",
                                      "M01:\n",
                                      "M01",
                                      "@1",
                                      "\\x0A",
                                      "0x",
                                      "0b",
                                      " hex",
                                      "H1023",
                                      "-2147483648",
                                      "4294967295",
                                      "; "})
    out += word(text);
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 1;
  write(fs::path(argv[1]) / "assembler.dict", assembler_words());
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
