/* The tables of the instruction set and the units, and the decoder. Their rows (IPOS_OPCODES and so on) are those of
 * vm/isa and stdlib. */
#include "embed/core/state.h"

enum { /* opcodes */
#define OPCODE_ROW(code, name, flow, a, b, c, d, keywords) Op_##name = code,
  IPOS_OPCODES(OPCODE_ROW)
};

typedef enum { Flow_Next, Flow_Jump, Flow_Branch, Flow_Call, Flow_Return, Flow_End, Flow_System, Flow_SystemCall } flow_kind;

/* Kinds of operands. A variable, bit, count or keyword shares a code word with others, a constant or label has one. */
enum { Kind_V, Kind_B, Kind_N, Kind_K, Kind_C, Kind_M, Kind_None = 7 };

enum { /* keyword sets */
  Keywords_none,
#define KEYWORDS_ROW(set, mask) Keywords_##set,
  IPOS_KEYWORDS(KEYWORDS_ROW)
};

/* By set: bit n, n is a word of it. */
static const uint16_t kKeywords[] = {0,
#define KEYWORDS_MASK(set, mask) mask,
                                     IPOS_KEYWORDS(KEYWORDS_MASK)};

/* By opcode: four kinds of 3 bits, the keyword set from bit 12 on. 0: no command. */
static const uint16_t kForms[128] = {
#define OPCODE_FORM(code, name, flow, a, b, c, d, keywords) \
  [code] = Kind_##a | Kind_##b << 3 | Kind_##c << 6 | Kind_##d << 9 | Keywords_##keywords << 12,
    IPOS_OPCODES(OPCODE_FORM)};

static const uint8_t kFlows[128] = {
#define OPCODE_FLOW(code, name, flow, a, b, c, d, keywords) [code] = Flow_##flow,
    IPOS_OPCODES(OPCODE_FLOW)};

static uint32_t kind_of(uint32_t form, unsigned operand) { return form >> (3 * operand) & 7; }

/* Blocks of variables that a command's operand begins. keyword -1: for all that have no row; variables 0: the count. */
static const struct {
  uint8_t opcode, operand;
  int8_t keyword;
  uint8_t variables;
} kBlocks[] = {
#define BLOCK_ROW(opcode, operand, keyword, variables) {Op_##opcode, operand, keyword, variables},
    IPOS_BLOCKS(BLOCK_ROW)};

enum { /* families of units */
#define FAMILY_ROW(name) Family_##name,
  IPOS_FAMILIES(FAMILY_ROW)
};

enum { Trait_NewVariables = 1, Trait_SynchronousSbus = 2, Trait_Sbus2 = 4 };

static const unit_type kUnits[] = {
#define UNIT_ROW(code, family, variables, words, tasks, depth, receive, traits) \
  {code, Family_##family, tasks, depth, receive, traits, variables, words},
    IPOS_UNITS(UNIT_ROW)};

/* The least variables that the operand begins. */
static uint32_t block_size(const instruction* command, unsigned operand) {
  int32_t keyword = -1;
  uint32_t count = 1;
  for (unsigned n = 0; n < 4; ++n) {
    const uint32_t kind = kind_of(command->form, n);
    if (kind == Kind_K) keyword = command->operands[n];
    if (kind == Kind_N) count = (uint32_t)command->operands[n];
  }
  for (;; keyword = -1) {
    uint32_t least = UINT32_MAX;
    for (unsigned n = 0; n < sizeof kBlocks / sizeof *kBlocks; ++n) {
      if (kBlocks[n].opcode != command->opcode || kBlocks[n].operand != operand || kBlocks[n].keyword != keyword)
        continue;
      const uint32_t size = kBlocks[n].variables == 0 ? count : kBlocks[n].variables;
      if (size < least) least = size;
    }
    if (least != UINT32_MAX) return least;
    if (keyword == -1) return 1;
  }
}

typedef enum { Decode_Ok, Decode_Unknown, Decode_Truncated, Decode_Reserved } decoding;

/* Word 0 has the opcode in bits 0..7 and two small operands in bits 8..19 and 20..31, a second word the next two; then
 * constants and labels follow. Bits of no operand are 0. */
static decoding decode(const uint32_t* code, uint32_t size, uint32_t at, instruction* out) {
  out->words = 1; /* of what is no command */
  if (at >= size) return Decode_Truncated;
  const uint32_t first = code[at];
  out->opcode = first & 0xFF;
  if (out->opcode >= sizeof kForms / sizeof *kForms || kForms[out->opcode] == 0) return Decode_Unknown;
  const uint32_t form = out->form = kForms[out->opcode];
  uint32_t small = 0, wide = 0;
  for (unsigned n = 0; n < 4; ++n) {
    const uint32_t kind = kind_of(form, n);
    if (kind <= Kind_K)
      ++small;
    else if (kind != Kind_None)
      ++wide;
  }
  const uint32_t packed = small > 2 ? 2 : 1;
  out->words = packed + wide;
  if (size - at < out->words) return Decode_Truncated;
  const uint32_t second = packed > 1 ? code[at + 1] : 0;
  const uint32_t fields[4] = {first >> 8 & 0xFFF, first >> 20, second & 0xFFFF, second >> 16};
  const uint32_t* next_wide = code + at + packed;
  const uint32_t* next_small = fields;
  for (unsigned n = 0; n < 4; ++n) {
    const uint32_t kind = kind_of(form, n);
    out->operands[n] = kind == Kind_None ? 0 : (int32_t)(kind <= Kind_K ? *next_small++ : *next_wide++);
  }
  for (; small < 4; ++small)
    if (fields[small] != 0) return Decode_Reserved;
  return Decode_Ok;
}
