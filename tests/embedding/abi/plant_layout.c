/* Prints sizes and offsets of the structures of ipos_plant.h. */
#include <ipos_plant.h>
#include <stdio.h>

#define SIZE(type) printf(#type " %zu\n", sizeof(type));
#define AT(type, member) printf(#type "." #member " %zu\n", offsetof(type, member));

int main(void) {
  SIZE(ipos_plant_status)
  SIZE(ipos_plant_source)
  AT(ipos_plant_source, text)
  AT(ipos_plant_source, folder)
  AT(ipos_plant_source, include_dirs)
  AT(ipos_plant_source, defines)
  AT(ipos_plant_source, flags)
  AT(ipos_plant_source, commands_a_ms)
  AT(ipos_plant_source, seed)
  SIZE(ipos_plant_mistake)
  AT(ipos_plant_mistake, text)
  AT(ipos_plant_mistake, line)
  AT(ipos_plant_mistake, column)
  SIZE(ipos_plant_station_info)
  AT(ipos_plant_station_info, program)
  SIZE(ipos_plant_signal_info)
  AT(ipos_plant_signal_info, factor)
  AT(ipos_plant_signal_info, decimals)
  AT(ipos_plant_signal_info, kind)
  AT(ipos_plant_signal_info, number)
  AT(ipos_plant_signal_info, flags)
  SIZE(ipos_plant_bus_info)
  AT(ipos_plant_bus_info, kind)
  AT(ipos_plant_bus_info, baud)
  SIZE(ipos_plant_load)
  AT(ipos_plant_load, lost)
  AT(ipos_plant_load, percent)
  SIZE(ipos_plant_frame)
  AT(ipos_plant_frame, id)
  AT(ipos_plant_frame, flags)
  AT(ipos_plant_frame, sender)
  AT(ipos_plant_frame, tag)
  AT(ipos_plant_frame, length)
  AT(ipos_plant_frame, data)
  SIZE(ipos_plant_telegram)
  AT(ipos_plant_telegram, end)
  AT(ipos_plant_telegram, bytes)
  AT(ipos_plant_telegram, length)
  AT(ipos_plant_telegram, valid)
  AT(ipos_plant_telegram, text)
  SIZE(ipos_plant_entry)
  AT(ipos_plant_entry, weight)
  AT(ipos_plant_entry, station)
  AT(ipos_plant_entry, text)
  return 0;
}
