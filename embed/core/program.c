/* Loading a program: the verifier, after which execution needs no checks but those on values. The rules are those of
 * vm/verify/rules.def. */
#include "embed/core/state.h"

enum { /* rules */
#define RULE_ROW(code, name, meaning) Rule_##name = code,
  IPOS_RULES(RULE_ROW)
};

/* A bit for each code word: a command starts here. */
typedef struct {
  uint32_t bits[(IPOS_PROGRAM_WORDS + 31) / 32];
} command_starts;

static bool is_start(const command_starts* starts, uint32_t words, uint32_t at) {
  return at < words && (starts->bits[at / 32] >> at % 32 & 1) != 0;
}

static void mark_start(command_starts* starts, uint32_t at) { starts->bits[at / 32] |= (uint32_t)1 << at % 32; }

static void report(ipos_trouble* trouble, unsigned rule, uint32_t at) {
  if (trouble->violations++ != 0) return;
  trouble->rule = (uint8_t)rule;
  trouble->word = at;
}

/* What rule an operand breaks, or 0. */
static unsigned operand_rule(const unit_type* unit, const instruction* command, unsigned n) {
  const uint32_t value = (uint32_t)command->operands[n];
  switch (kind_of(command->form, n)) {
    case Kind_V:
      if (value >= unit->variables) return Rule_VariableRange;
      return block_size(command, n) > unit->variables - value ? Rule_StructureRange : 0;
    case Kind_B: return value > 31 ? Rule_BitRange : 0;
    case Kind_N: return value < 1 ? Rule_StructureRange : 0;
    case Kind_K: return value > 15 || (kKeywords[command->form >> 12] >> value & 1) == 0 ? Rule_UnknownKeyword : 0;
    default: return 0;
  }
}

/* Checks the command at `at`; returns its length, 1 for what is none. */
static uint32_t check_command(const ipos_program* program, uint32_t at, command_starts* starts, ipos_trouble* trouble) {
  const unit_type* const unit = program->unit;
  instruction command;
  switch (decode(program->code, program->words, at, &command)) {
    case Decode_Unknown: report(trouble, Rule_UnknownOpcode, at); return 1;
    case Decode_Truncated:
      report(trouble, Rule_TruncatedCommand, at);
      return program->words - at; /* what follows is part of it */
    case Decode_Reserved: report(trouble, Rule_ReservedBits, at); break;
    case Decode_Ok: break;
  }
  mark_start(starts, at);
  for (unsigned n = 0; n < 4; ++n) {
    const unsigned rule = operand_rule(unit, &command, n);
    if (rule != 0) report(trouble, rule, at);
  }
  if ((command.opcode == Op_Task2 && unit->tasks < 2) ||
      ((command.opcode == Op_Task || command.opcode == Op_VarInt) && unit->tasks < 3))
    report(trouble, Rule_TaskMissing, at);
  const uint8_t flow = kFlows[command.opcode];
  if (at + command.words == program->words && flow != Flow_Jump && flow != Flow_Return && flow != Flow_End)
    report(trouble, Rule_RunsOffEnd, at);
  return command.words;
}

APART static void verify(const ipos_program* program, ipos_trouble* trouble) {
  const uint32_t words = program->words;
  const uint32_t longest =
      program->unit->program_words < IPOS_PROGRAM_WORDS ? program->unit->program_words : IPOS_PROGRAM_WORDS;
  if (words == 0) report(trouble, Rule_EmptyCode, 0);
  if (words > longest) report(trouble, Rule_TooLong, longest);
  if (trouble->violations != 0) return;
  command_starts starts;
  memset(&starts, 0, sizeof starts);
  for (uint32_t at = 0; at < words;) at += check_command(program, at, &starts, trouble);
  for (uint32_t at = 0; at < words; ++at) {
    instruction command;
    if (!is_start(&starts, words, at)) continue;
    decode(program->code, words, at, &command);
    for (unsigned n = 0; n < 4; ++n)
      if (kind_of(command.form, n) == Kind_M && !is_start(&starts, words, (uint32_t)command.operands[n]))
        report(trouble, Rule_LabelTarget, at);
  }
}

static ipos_status check_memory(const void* memory, size_t size, size_t needed, size_t alignment) {
  if (memory == NULL) return IPOS_INVALID_ARGUMENT;
  if ((uintptr_t)memory % alignment != 0) return IPOS_MISALIGNED;
  return size < needed ? IPOS_MEMORY_TOO_SMALL : IPOS_OK;
}

static const unit_type* find_unit(uint32_t code) {
  for (unsigned n = 0; n < sizeof kUnits / sizeof *kUnits; ++n)
    if (kUnits[n].code == code) return &kUnits[n];
  return NULL;
}

static ipos_status load(ipos_program* program, const uint8_t* image, size_t size, ipos_trouble* trouble) {
  section sections[kSections + 1];
  uint32_t unit;
  memset(sections, 0, sizeof sections);
  const ipos_status status = view_image(image, size, sections, &unit, &program->checksum, &trouble->offset);
  if (status != IPOS_OK) return status;
  trouble->offset = 8;
  program->unit = find_unit(unit);
  if (program->unit == NULL || program->unit->tasks == 0) return IPOS_UNKNOWN_UNIT;
  if (program->unit->variables > IPOS_VARIABLES) return IPOS_UNIT_TOO_LARGE;

  const section code = sections[Section_Code];
  trouble->offset = code.offset;
  if (code.size % 4 != 0) return IPOS_IMAGE_DAMAGED;
  program->code = (const uint32_t*)(const void*)(image + code.offset); /* aligned: it is the first section */
  program->words = code.size / 4;
  program->symbols = image + sections[Section_Symbols].offset;
  program->symbols_end = program->symbols + sections[Section_Symbols].size;
  program->symbol_count = 0;
  for (const uint8_t* at = program->symbols; at != program->symbols_end; ++program->symbol_count) {
    ipos_symbol symbol;
    const bool sound = read_symbol(&at, program->symbols_end, &symbol);
    trouble->offset = (uint32_t)(at - image);
    if (!sound || (uint32_t)symbol.variable + symbol.count > program->unit->variables) return IPOS_IMAGE_DAMAGED;
  }
  program->fast = NULL;
  verify(program, trouble);
  trouble->offset = trouble->violations != 0 ? code.offset + 4 * trouble->word : 0;
  return trouble->violations != 0 ? IPOS_REFUSED : IPOS_OK;
}

size_t ipos_program_size(void) { return sizeof(ipos_program); }

ipos_status ipos_program_load(void* memory, size_t size, const void* image, size_t image_size,
                              ipos_program** program, ipos_trouble* trouble) {
  ipos_trouble ours;
  memset(&ours, 0, sizeof ours);
  if (image == NULL || program == NULL) return IPOS_INVALID_ARGUMENT;
  ipos_status status = check_memory(memory, size, sizeof(ipos_program), 8);
  if (status == IPOS_OK) status = check_memory(image, image_size, 0, 4);
  if (status == IPOS_OK) status = load(memory, image, image_size, &ours);
  if (status == IPOS_OK) *program = memory;
  if (trouble != NULL) *trouble = ours;
  return status;
}

ipos_status ipos_program_info_of(const ipos_program* program, ipos_program_info* info) {
  if (program == NULL || info == NULL) return IPOS_INVALID_ARGUMENT;
  info->unit = program->unit->code;
  info->tasks = program->unit->tasks;
  info->call_depth = program->unit->call_depth;
  info->variables = program->unit->variables;
  info->words = program->words;
  info->symbols = program->symbol_count;
  info->checksum = program->checksum;
  return IPOS_OK;
}

#if !IPOS_FAST
size_t ipos_accelerate_size(const ipos_program* program) {
  (void)program;
  return 0;
}
ipos_status ipos_program_accelerate(ipos_program* program, void* memory, size_t size) {
  (void)memory, (void)size;
  return program == NULL ? IPOS_INVALID_ARGUMENT : IPOS_NOT_BUILT_IN;
}
#endif
