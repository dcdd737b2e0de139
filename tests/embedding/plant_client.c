/* A client of libipos_plant: does much of what a user can do with a plant and prints what comes of it, so that the library of
 * one system can be compared with that of another. Texts, frames, saved bytes and the trace hash are all in it.
 * usage: plant_client PLANT.toml...      %C3 is the byte C3: names on a command line of Windows are no UTF-8 */
#include <inttypes.h>
#include <ipos_plant.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SECOND INT64_C(1000000000)

static void fail(const ipos_plant* plant, const char* what, ipos_plant_status status) {
  printf("%s: %s: %s\n", what, ipos_plant_status_text(status), ipos_plant_message(plant));
  for (size_t n = 0; n < ipos_plant_mistakes(plant); ++n) {
    ipos_plant_mistake mistake;
    if (ipos_plant_mistake_at(plant, n, &mistake) == IPOS_PLANT_OK)
      printf("%s:%" PRIu32 ":%" PRIu32 ": %s\n", mistake.file, mistake.line, mistake.column, mistake.text);
  }
  exit(1);
}

/* FNV-1a, 64 bits. */
static uint64_t add(uint64_t hash, const void* bytes, size_t size) {
  const unsigned char* each = bytes;
  while (size-- > 0) hash = (hash ^ *each++) * UINT64_C(0x100000001B3);
  return hash;
}

static void show_signals(ipos_plant* plant, uint32_t station) {
  for (ipos_plant_kind kind = IPOS_PLANT_VARIABLE; kind <= IPOS_PLANT_WORD; ++kind) {
    const char* name;
    for (uint32_t number = 0; ipos_plant_name_at(plant, station, kind, NULL, number, &name) == IPOS_PLANT_OK; ++number) {
      char kept[200];
      uint32_t signal;
      const char* text;
      int64_t value;
      snprintf(kept, sizeof kept, "%s", name);
      if (ipos_plant_find(plant, station, kind, kept, &signal) != IPOS_PLANT_OK) continue;
      if (ipos_plant_read(plant, signal, &value) != IPOS_PLANT_OK) continue;
      if (ipos_plant_read_text(plant, signal, &text) != IPOS_PLANT_OK) text = "none";
      printf("  %d %s = %" PRId64 " (%s)\n", (int)kind, kept, value, text);
    }
  }
}

static void show_buses(ipos_plant* plant) {
  ipos_plant_bus_info bus;
  for (uint32_t number = 0; ipos_plant_bus_at(plant, number, &bus) == IPOS_PLANT_OK; ++number) {
    uint64_t hash = UINT64_C(0xCBF29CE484222325), count = 0;
    ipos_plant_load load;
    if (bus.kind == IPOS_PLANT_CAN) {
      ipos_plant_frame frames[100];
      size_t got;
      while (ipos_plant_receive(plant, number, frames, 100, &got) == IPOS_PLANT_OK && got > 0)
        for (size_t n = 0; n < got; ++n, ++count) {
          hash = add(hash, &frames[n].time, sizeof frames[n].time);
          hash = add(hash, &frames[n].id, sizeof frames[n].id);
          hash = add(hash, frames[n].data, frames[n].length);
        }
    } else {
      ipos_plant_telegram telegram;
      for (; ipos_plant_serial_receive(plant, number, &telegram) == IPOS_PLANT_OK; ++count) {
        hash = add(hash, &telegram.end, sizeof telegram.end);
        hash = add(hash, telegram.bytes, telegram.length);
        hash = add(hash, telegram.text, strlen(telegram.text));
      }
    }
    if (ipos_plant_bus_load(plant, number, &load) != IPOS_PLANT_OK) continue;
    printf("  %s: %" PRIu64 " taken %016" PRIx64 ", %" PRIu64 " carried, %.6f %%\n", bus.name, count, hash, load.frames, load.percent);
  }
}

static bool past(void* user, ipos_plant* plant) {
  int64_t now = 0;
  ipos_plant_time(plant, &now);
  return now >= *(int64_t*)user;
}

static void play(const char* path) {
  const ipos_plant_source source = {.path = path};
  ipos_plant *plant, *again;
  ipos_plant_status status = ipos_plant_open(&source, &plant);
  if (status != IPOS_PLANT_OK) fail(plant, "open", status);
  printf("%s\n", path);
  if ((status = ipos_plant_run(plant, SECOND / 2)) != IPOS_PLANT_OK) fail(plant, "run", status);

  /* A fault, no power for a while, a condition. */
  ipos_plant_drive_fault(plant, 0, 7);
  const char* why;
  if (ipos_plant_why(plant, 0, &why) == IPOS_PLANT_OK) printf("  why: %s\n", why);
  ipos_plant_run(plant, SECOND);
  ipos_plant_reset_fault(plant, 0);
  ipos_plant_power(plant, 0, false);
  int64_t until = SECOND + SECOND / 4;
  if ((status = ipos_plant_run_until(plant, 2 * SECOND, past, &until)) != IPOS_PLANT_OK) fail(plant, "run_until", status);
  ipos_plant_power(plant, 0, true);
  ipos_plant_run(plant, 2 * SECOND);

  ipos_plant_station_info station;
  for (uint32_t number = 0; ipos_plant_station_at(plant, number, &station) == IPOS_PLANT_OK; ++number) {
    printf("  %s, %s, %s, %s\n", station.name, station.unit, station.title, station.program);
    show_signals(plant, number);
  }
  show_buses(plant);
  ipos_plant_entry entry;
  for (size_t n = 0; ipos_plant_journal_at(plant, n, &entry) == IPOS_PLANT_OK; ++n)
    printf("  %" PRId64 " %d %s %s\n", entry.time, (int)entry.weight, entry.station, entry.text);

  /* The saved state in another plant, and the hash of both. */
  size_t size = 0;
  if (ipos_plant_save(plant, NULL, &size) != IPOS_PLANT_TOO_SMALL) fail(plant, "size", IPOS_PLANT_TOO_SMALL);
  void* bytes = malloc(size);
  if (bytes == NULL || (status = ipos_plant_save(plant, bytes, &size)) != IPOS_PLANT_OK) fail(plant, "save", status);
  printf("  saved: %zu bytes\n", size);
  if ((status = ipos_plant_open(&source, &again)) != IPOS_PLANT_OK) fail(again, "again", status);
  if ((status = ipos_plant_restore(again, bytes, size)) != IPOS_PLANT_OK) fail(again, "restore", status);
  free(bytes);
  uint64_t hash = 0, other = 1;
  if ((status = ipos_plant_trace_hash(plant, &hash)) != IPOS_PLANT_OK) fail(plant, "hash", status);
  if ((status = ipos_plant_trace_hash(again, &other)) != IPOS_PLANT_OK) fail(again, "hash", status);
  printf("  hash: %016" PRIx64 " %016" PRIx64 "\n", hash, other);
  if (hash != other || ipos_plant_close(plant) != IPOS_PLANT_OK || ipos_plant_close(again) != IPOS_PLANT_OK) exit(1);
}

/* What is wrong has to be told, and nothing may end the program. */
static void misuse(void) {
  ipos_plant_source source = {.path = "there/is/none.toml"};
  ipos_plant* plant;
  printf("%s", ipos_plant_status_text(ipos_plant_open(&source, &plant)));
  ipos_plant_mistake mistake = {0};
  if (ipos_plant_mistake_at(plant, 0, &mistake) == IPOS_PLANT_OK) printf(": %s: %s", mistake.file, mistake.text);
  printf("\n%s\n", ipos_plant_status_text(ipos_plant_run(plant, SECOND)));
  ipos_plant_close(plant);
  source.path = NULL;
  source.text = "[[station]]\nname = \"a\"\nunit = \"mdxc\"\n";
  printf("%s\n", ipos_plant_status_text(ipos_plant_open(&source, &plant)));
  for (size_t n = 0; ipos_plant_mistake_at(plant, n, &mistake) == IPOS_PLANT_OK; ++n)
    printf("%s:%" PRIu32 ":%" PRIu32 ": %s\n", mistake.file, mistake.line, mistake.column, mistake.text);
  ipos_plant_close(plant);
  printf("%s\n", ipos_plant_status_text(ipos_plant_run(NULL, SECOND)));
}

static char* decoded(char* name) {
  char* to = name;
  for (const char* from = name; *from != 0; ++to) {
    const char digits[3] = {from[0] == '%' ? from[1] : (char)0, from[0] == '%' && from[1] != 0 ? from[2] : (char)0, 0};
    *to = digits[1] != 0 ? (char)strtol(digits, NULL, 16) : *from;
    from += digits[1] != 0 ? 3 : 1;
  }
  *to = 0;
  return name;
}

int main(int count, char** files) {
  printf("%" PRIu32 "\n", ipos_plant_version());
  misuse();
  for (int n = 1; n < count; ++n) play(decoded(files[n]));
  return 0;
}
