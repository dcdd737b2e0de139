// Loading programs, and looking at them.
#include <bit>
#include <cstring>
#include <new>

#include "embed/objects.hpp"

static_assert(std::endian::native == std::endian::little, "images are used in place");

namespace ipos::api {
namespace {

constexpr size_t kAlignment = 8;

ipos_status status_of(vm::ImageError error) {
  switch (error) {
    case vm::ImageError::None: return IPOS_OK;
    case vm::ImageError::TooShort:
    case vm::ImageError::BadMagic: return IPOS_NOT_AN_IMAGE;
    case vm::ImageError::BadVersion: return IPOS_IMAGE_VERSION;
    default: return IPOS_IMAGE_DAMAGED;
  }
}

// The number of symbols; nothing when the table is damaged or goes beyond the unit's variables, then at trouble.offset.
std::optional<uint32_t> count_symbols(vm::Reader in, uint32_t variables, ipos_trouble& trouble) {
  uint32_t count = 0;
  for (; !in.at_end(); ++count)
    if (const auto symbol = vm::read_symbol(in); !symbol || symbol->variable + symbol->count > variables) {
      trouble.offset = in.offset();
      return std::nullopt;
    }
  return count;
}

ipos_status load(void* memory, std::span<const uint8_t> bytes, ipos_program*& out, ipos_trouble& trouble) {
  const vm::ImageViewResult container = vm::view_image(bytes);
  trouble.offset = container.offset;
  if (container.error != vm::ImageError::None) return status_of(container.error);
  const stdlib::UnitType* unit = stdlib::find_unit(container.view.unit);
  trouble.offset = 8;
  if (unit == nullptr || unit->tasks == 0) return IPOS_UNKNOWN_UNIT;
  if (unit->variables > vm::kMaxVariables) return IPOS_UNIT_TOO_LARGE;

  const auto& code = container.view.section(vm::Section::Code);
  trouble.offset = code.offset;
  if (code.bytes.size() % sizeof(uint32_t) != 0) return IPOS_IMAGE_DAMAGED;
  const auto& symbols = container.view.section(vm::Section::Symbols);
  const auto symbol_count = count_symbols(container.view.reader(vm::Section::Symbols), unit->variables, trouble);
  if (!symbol_count) return IPOS_IMAGE_DAMAGED;

  const std::span words(reinterpret_cast<const uint32_t*>(code.bytes.data()),
                        code.bytes.size() / sizeof(uint32_t));
  const vm::Limits limits{unit->variables, unit->program_words, unit->tasks, unit->call_depth};
  vm::Violation first{};
  const vm::Verification verified = vm::verify(words, limits, {&first, 1});
  if (!verified.image) {
    trouble.offset = code.offset + static_cast<uint32_t>(sizeof(uint32_t)) * first.address;
    trouble.word = first.address;
    trouble.rule = static_cast<uint8_t>(first.rule);
    trouble.violations = verified.violations;
    return IPOS_REFUSED;
  }
  trouble = {};
  out = new (memory) ipos_program {
    *verified.image, unit, symbols, *symbol_count, container.view.checksum,
#if IPOS_FAST
        std::nullopt
#endif
  };
  return IPOS_OK;
}

// "H420"
std::optional<uint16_t> numbered(std::string_view name, uint32_t variables) {
  if (name.size() < 2 || name[0] != 'H' || name.size() > 5) return std::nullopt;
  uint32_t number = 0;
  for (const char digit : name.substr(1)) {
    if (digit < '0' || digit > '9') return std::nullopt;
    number = 10 * number + static_cast<uint32_t>(digit - '0');
  }
  if (number >= variables) return std::nullopt;
  return static_cast<uint16_t>(number);
}

ipos_symbol to_c(const vm::SymbolView& symbol) {
  return {symbol.name.data(), symbol.name.size(), symbol.variable, symbol.count};
}

}  // namespace

ipos_status check_memory(const void* memory, size_t size, size_t needed, size_t alignment) {
  if (memory == nullptr) return IPOS_INVALID_ARGUMENT;
  if (reinterpret_cast<uintptr_t>(memory) % alignment != 0) return IPOS_MISALIGNED;
  return size < needed ? IPOS_MEMORY_TOO_SMALL : IPOS_OK;
}

}  // namespace ipos::api

using namespace ipos;  // NOLINT

size_t ipos_program_size(void) { return sizeof(ipos_program); }

ipos_status ipos_program_load(void* memory, size_t size, const void* image, size_t image_size,
                              ipos_program** program, ipos_trouble* trouble) {
  ipos_trouble ours{};
  if (image == nullptr || program == nullptr) return IPOS_INVALID_ARGUMENT;
  ipos_status status = api::check_memory(memory, size, sizeof(ipos_program), api::kAlignment);
  if (status == IPOS_OK) status = api::check_memory(image, image_size, 0, alignof(uint32_t));
  if (status == IPOS_OK)
    status = api::load(memory, {static_cast<const uint8_t*>(image), image_size}, *program, ours);
  if (trouble != nullptr) *trouble = ours;
  return status;
}

const char* ipos_rule_text(uint8_t rule) {
  for (const vm::RuleInfo& row : vm::rule_table())
    if (static_cast<uint8_t>(row.rule) == rule) return row.meaning;
  return "";
}

ipos_status ipos_program_info_of(const ipos_program* program, ipos_program_info* info) {
  if (program == nullptr || info == nullptr) return IPOS_INVALID_ARGUMENT;
  *info = {program->unit->code,
           program->unit->tasks,
           program->unit->call_depth,
           program->unit->variables,
           static_cast<uint32_t>(program->verified.code().size()),
           program->symbol_count,
           program->checksum};
  return IPOS_OK;
}

#if IPOS_FAST
size_t ipos_accelerate_size(const ipos_program* program) {
  if (program == nullptr) return 0;
  return sizeof(vm::fast::Slot) * vm::fast::Predecoded::slots_needed(program->verified.code().size());
}

ipos_status ipos_program_accelerate(ipos_program* program, void* memory, size_t size) {
  if (program == nullptr) return IPOS_INVALID_ARGUMENT;
  const size_t needed = ipos_accelerate_size(program);
  const ipos_status status = api::check_memory(memory, size, needed, api::kAlignment);
  if (status != IPOS_OK) return status;
  program->fast.emplace(program->verified,
                        std::span(static_cast<vm::fast::Slot*>(memory), needed / sizeof(vm::fast::Slot)));
  return IPOS_OK;
}
#else
size_t ipos_accelerate_size(const ipos_program*) { return 0; }
ipos_status ipos_program_accelerate(ipos_program* program, void*, size_t) {
  return program == nullptr ? IPOS_INVALID_ARGUMENT : IPOS_NOT_BUILT_IN;
}
#endif

ipos_status ipos_symbol_at(const ipos_program* program, uint32_t index, ipos_symbol* symbol) {
  if (program == nullptr || symbol == nullptr) return IPOS_INVALID_ARGUMENT;
  vm::Reader in = program->symbol_reader();
  while (!in.at_end()) {
    const auto row = vm::read_symbol(in);
    if (!row) break;
    if (index-- != 0) continue;
    *symbol = api::to_c(*row);
    return IPOS_OK;
  }
  return IPOS_NO_SYMBOL;
}

ipos_status ipos_find(const ipos_program* program, const char* name, ipos_symbol* symbol) {
  if (program == nullptr || name == nullptr || symbol == nullptr) return IPOS_INVALID_ARGUMENT;
  const std::string_view wanted = name;
  vm::Reader in = program->symbol_reader();
  while (!in.at_end()) {
    const auto row = vm::read_symbol(in);
    if (!row) break;
    if (row->name != wanted) continue;
    *symbol = api::to_c(*row);
    return IPOS_OK;
  }
  const auto number = api::numbered(wanted, program->unit->variables);
  if (!number) return IPOS_NO_SYMBOL;
  *symbol = {name, wanted.size(), *number, 1};
  return IPOS_OK;
}
