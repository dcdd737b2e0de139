// Names of files are UTF-8 in all of our texts. The C library of Windows (msvcrt) knows no locale of UTF-8, so the standard
// library would take each byte of a name for a letter. Every way from chars to the wide letters of Windows goes through
// mbrtowc: the linker puts this one in its place, in programs and in the library (cmake/windows.cmake).
#include <cstddef>
#include <cwchar>
#include <utility>

namespace {

// How many bytes a letter that begins with this one has; 0: none begins so.
size_t length_of(unsigned char first) {
  if (first < 0x80) return 1;
  if (first < 0xC2) return 0;
  if (first < 0xE0) return 2;
  if (first < 0xF0) return 3;
  return first < 0xF5 ? 4 : 0;
}

bool is_permitted(char32_t letter, size_t length) {
  const bool too_long = (length == 3 && letter < 0x800) || (length == 4 && letter < 0x10000);
  const bool surrogate = letter >= 0xD800 && letter < 0xE000;
  return !too_long && !surrogate && letter < 0x110000;
}

}  // namespace

// As the C standard has it, but that a letter beyond 16 bits is two: its first three bytes give the first surrogate, its
// last one gives the second, which `state` keeps meanwhile. A byte that belongs to no letter of UTF-8 is one of Latin 1: so
// old sources name their files.
extern "C" size_t __wrap_mbrtowc(wchar_t* out, const char* bytes, size_t size, mbstate_t* state) {
  static thread_local mbstate_t own{};
  mbstate_t& kept = state == nullptr ? own : *state;
  const auto give = [out](char32_t letter, size_t length) {
    if (out != nullptr) *out = static_cast<wchar_t>(letter);
    return letter == 0 ? 0 : length;
  };
  if (bytes == nullptr) {
    kept = mbstate_t{};
    return 0;
  }
  if (size == 0) return static_cast<size_t>(-2);
  if (kept != 0) return give(static_cast<char32_t>(std::exchange(kept, mbstate_t{})), 1);
  const auto first = static_cast<unsigned char>(*bytes);
  const size_t length = length_of(first);
  if (length < 2 || length > size) return give(first, 1);
  char32_t letter = first & (0x7FU >> length);
  for (size_t n = 1; n < length; ++n) {
    const auto byte = static_cast<unsigned char>(bytes[n]);
    if ((byte & 0xC0U) != 0x80) return give(first, 1);
    letter = letter << 6U | (byte & 0x3FU);
  }
  if (!is_permitted(letter, length)) return give(first, 1);
  if (length < 4) return give(letter, length);
  kept = static_cast<mbstate_t>(0xDC00 + (letter & 0x3FFU));
  return give(0xD7C0 + (letter >> 10U), 3);
}
