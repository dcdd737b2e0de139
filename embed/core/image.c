/* The container of an image (.ipx, docs/reference/isa.md): checksum, sections, symbols. Nothing is copied. */
#include "embed/core/state.h"

enum { Section_Code = 1, Section_Symbols = 2, kSections = 4, kHeaderSize = 16, kSectionSize = 12 };

typedef struct {
  uint32_t offset; /* 0: the image has no such section */
  uint32_t size;
} section;

static uint32_t u16_at(const uint8_t* bytes) { return bytes[0] | (uint32_t)bytes[1] << 8; }
static uint32_t u32_at(const uint8_t* bytes) { return u16_at(bytes) | u16_at(bytes + 2) << 16; }

/* CRC-32 of IEEE 802.3, by half bytes: a table of 64 bytes. */
static uint32_t crc32(const uint8_t* bytes, size_t size) {
  static const uint32_t table[16] = {0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC, 0x76DC4190, 0x6B6B51F4,
                                     0x4DB26158, 0x5005713C, 0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C,
                                     0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C};
  uint32_t crc = 0xFFFFFFFF;
  for (; size != 0; --size) {
    crc ^= *bytes++;
    crc = table[crc & 0xF] ^ crc >> 4;
    crc = table[crc & 0xF] ^ crc >> 4;
  }
  return ~crc;
}

/* Fills the sections by kind and the checksum. *offset: the byte where the trouble was seen. */
static ipos_status view_image(const uint8_t* bytes, size_t size, section sections[kSections + 1], uint32_t* unit,
                              uint32_t* checksum, uint32_t* offset) {
  *offset = 0;
  if (size < 4 || u32_at(bytes) != 0x31585049) return IPOS_NOT_AN_IMAGE; /* "IPX1" */
  *offset = (uint32_t)size;
  if (size < kHeaderSize + 4 || size > 0xFFFFFFFF) return IPOS_NOT_AN_IMAGE;
  *offset = 4;
  if (u32_at(bytes + 4) != 1) return IPOS_IMAGE_VERSION;
  const uint32_t end = *offset = (uint32_t)size - 4;
  *checksum = u32_at(bytes + end);
  if (*checksum != crc32(bytes, end)) return IPOS_IMAGE_DAMAGED;
  *offset = 8;
  *unit = u32_at(bytes + 8);
  if (*unit > 0xFF) return IPOS_IMAGE_DAMAGED;
  *offset = 12;
  const uint32_t count = u32_at(bytes + 12);
  if (count > kSections || end < kHeaderSize + count * kSectionSize) return IPOS_IMAGE_DAMAGED;
  uint32_t expected = kHeaderSize + count * kSectionSize;
  uint32_t last_kind = 0;
  for (const uint8_t* row = bytes + kHeaderSize; row < bytes + kHeaderSize + count * kSectionSize; row += kSectionSize) {
    const uint32_t kind = u32_at(row);
    const section here = {u32_at(row + 4), u32_at(row + 8)};
    *offset = (uint32_t)(row - bytes);
    if (here.offset != expected || here.size > end - expected || kind <= last_kind || kind > kSections)
      return IPOS_IMAGE_DAMAGED;
    sections[kind] = here;
    last_kind = kind;
    expected += here.size;
  }
  *offset = expected;
  if (expected != end) return IPOS_IMAGE_DAMAGED;
  *offset = kHeaderSize;
  return sections[Section_Code].offset != 0 ? IPOS_OK : IPOS_IMAGE_DAMAGED;
}

/* Reads the symbol at *at and moves *at behind it; on damage to the byte where it was seen, and false. */
static bool read_symbol(const uint8_t** at, const uint8_t* end, ipos_symbol* symbol) {
  const uint8_t* const row = *at;
  if (end - row < 6) {
    *at = end;
    return false;
  }
  symbol->variable = (uint16_t)u16_at(row);
  symbol->count = (uint16_t)u16_at(row + 2);
  symbol->length = u16_at(row + 4);
  symbol->name = (const char*)row + 6;
  *at = row + 6;
  if ((size_t)(end - *at) < symbol->length) return false;
  *at += symbol->length;
  return symbol->count != 0;
}

/* "H420": its number, or IPOS_VARIABLES for what is none. */
static uint32_t numbered(const char* name) {
  uint32_t number = 0;
  const char* digit = name + 1;
  if (name[0] != 'H') return IPOS_VARIABLES;
  for (; *digit >= '0' && *digit <= '9' && digit - name < 5; ++digit) number = 10 * number + (uint32_t)(*digit - '0');
  return *digit == 0 && digit != name + 1 ? number : IPOS_VARIABLES;
}

ipos_status ipos_symbol_at(const ipos_program* program, uint32_t index, ipos_symbol* symbol) {
  if (program == NULL || symbol == NULL) return IPOS_INVALID_ARGUMENT;
  ipos_symbol row;
  for (const uint8_t* at = program->symbols; at != program->symbols_end;) {
    read_symbol(&at, program->symbols_end, &row);
    if (index-- != 0) continue;
    *symbol = row;
    return IPOS_OK;
  }
  return IPOS_NO_SYMBOL;
}

ipos_status ipos_find(const ipos_program* program, const char* name, ipos_symbol* symbol) {
  if (program == NULL || name == NULL || symbol == NULL) return IPOS_INVALID_ARGUMENT;
  const size_t length = strlen(name);
  ipos_symbol row;
  for (const uint8_t* at = program->symbols; at != program->symbols_end;) {
    read_symbol(&at, program->symbols_end, &row);
    if (row.length != length || memcmp(row.name, name, length) != 0) continue;
    *symbol = row;
    return IPOS_OK;
  }
  row.variable = (uint16_t)numbered(name);
  if (row.variable >= program->unit->variables) return IPOS_NO_SYMBOL;
  row.name = name;
  row.length = length;
  row.count = 1;
  *symbol = row;
  return IPOS_OK;
}
