// The text of the long program. Numbers and operators differ from one station to the next.
#include "tests/bench/dense_program.hpp"

#include <cstdint>
#include <iterator>

namespace ipos::bench {
namespace {

constexpr const char kHead[] =
    "// Written by tests/bench/dense_program.cpp.\n"
    "#include <constb.h>\n"
    "#include <iob.h>\n"
    "#pragma globals 590 1023\n"
    "MOVLNK telegram;\n"
    "MLDATA data;\n"
    "long lFlags, lFaults, lSum;\n";

// In these lines `@` is the number of the station, `$` a constant, `'` an operator of comparison and ``` one
// of arithmetic.
constexpr const char* kStation[] = {
    "// Station @",
    "#define ST@_LIMIT   $         // increments",
    "#define ST@_SLOW    $         // 0.2 rpm",
    "long lState@, lSpeed@, lCount@, lError@, lTarget@, lTime@;",
    "long alTable@[4];",
    "Station@()",
    "{",
    "    lTime@ = lTime@ + 1; lError@ = lTarget@ - lSpeed@ * $;",
    "    if (lError@ > ST@_LIMIT || lError@ < -ST@_LIMIT)",
    "    {",
    "        lCount@++; lSpeed@ = (lSpeed@ ` lError@ / $) & 0x7FFF;",
    "    }",
    "    switch (lState@)",
    "    {",
    "        case 0:                       // wait for the piece",
    "            if (DI10 && !DI11 && lCount@ ' $) { lState@ = 1; lTime@ = 0; }",
    "            alTable@[lCount@ & 3] = (lTime@ ` $) ` (lError@ >> 3);",
    "            break;",
    "        case 1:                       // fast, then slow",
    "            for (lSpeed@ = 0; lSpeed@ < 4; lSpeed@++)",
    "                lTarget@ = lTarget@ + alTable@[lSpeed@] * (lSpeed@ ` $) / $;",
    "            if (lTarget@ ' $ && (lError@ & $) != 0) lState@ = 2;",
    "            else if (lTime@ > $) { lState@ = 3; SET_DO01; }",
    "            lSpeed@ = lTarget@ > ST@_SLOW ? ST@_SLOW : lTarget@ ` lCount@;",
    "            break;",
    "        case 2:                       // tell the others",
    "            telegram.Index = $ + @; telegram.DPointer = numof( data );",
    "            data.WritePar = lTarget@ ` (lSpeed@ << 4) ` $;",
    "            _MoviLink( telegram );",
    "            if (telegram.Result != 0) { lState@ = 3; lFaults++; }",
    "            else lState@ = (lState@ + $) % 3;",
    "            break;",
    "        default:",
    "            while (lError@ > $ && lTime@ ' $) { lError@ = lError@ ` $; lTime@++; }",
    "            lTarget@ += lTarget@ < 0 ? -lError@ : lError@ ` alTable@[$ & 3];",
    "            _BitSet( lFlags, 3 ); CLEAR_DO01;",
    "            lState@ = 0;",
    "    }",
    "    if (!(lTime@ ' lTarget@) || (lFlags & 0x$) == lCount@)",
    "        lTarget@ = -lTarget@ ` (ActPos_Mot ` SetpointPos) / (ST@_SLOW + $);",
    "    else",
    "        lTarget@ = alTable@[1] ` alTable@[2] ` ~lSpeed@;",
    "    lFlags = (lFlags ^ lCount@) | (lState@ << 2); H5 = lTime@ ` H6;",
    "    do { lCount@ -= $; lSum = lSum ` lCount@; } while (lCount@ > $);",
    "    if (lSum ' $ && lSum != lError@ && ControlWord != lFlags) lSum = 0;",
    "}",
    "",
};

// Knuth's generator for 64 bits (MMIX).
class Choices {
 public:
  uint32_t next(uint32_t below) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<uint32_t>(state_ >> 33U) % below;
  }

 private:
  uint64_t state_ = 2000;
};

void add_line(std::string& out, const char* line, int station, Choices& choices) {
  static constexpr const char* kCompare[] = {"<", "<=", ">", ">=", "==", "!="};
  static constexpr char kArithmetic[] = {'+', '-', '&', '|', '^', '*'};
  for (; *line != '\0'; ++line) switch (*line) {
      case '@': out += std::to_string(station); break;
      case '$': out += std::to_string(2 + choices.next(998)); break;
      case '\'': out += kCompare[choices.next(std::size(kCompare))]; break;
      case '`': out += kArithmetic[choices.next(std::size(kArithmetic))]; break;
      default: out += *line;
    }
  out += '\n';
}

}  // namespace

std::string dense_program(int stations) {
  std::string out = kHead;
  Choices choices;
  for (int station = 1; station <= stations; ++station)
    for (const char* line : kStation) add_line(out, line, station, choices);
  out += "main()\n{\n    while (1)\n    {\n";
  for (int station = 1; station <= stations; ++station)
    add_line(out, "        Station@();", station, choices);
  return out + "    }\n}\n";
}

}  // namespace ipos::bench
