// Messages of the Zaber ASCII protocol. Source: Zaber Technologies, "ASCII Protocol Manual"
// (firmware 6.06 and up, https://www.zaber.com/wiki/Manuals/ASCII_Protocol_Manual), sections
// "Message Format", "Warning Flags" and "Checksumming":
//
//   command  /1 0 07 move abs 10000:XX      address, axis (0: the device), message id, text
//   reply    @01 0 07 OK BUSY -- 0:XX       ... OK or RJ, IDLE or BUSY, warning flag, data
//   info     #01 0 07 text                  alert   !01 1 IDLE --
//
// XX is optional: the two hexadecimal digits of the LRC, which makes the sum of all bytes between
// the first character and the colon, and the checksum itself, 0 modulo 256.
#pragma once

#include <string>

namespace hydrodip {

std::string zaber_checksum(const std::string& between);

// With checksum and line end. `id` is 0 to 99.
std::string zaber_command(int address, int axis, int id, const std::string& text);

struct ZaberReply {
  int address = 0;
  int axis = 0;
  int id = -1;  // -1: none
  bool accepted = false;
  bool busy = false;
  std::string flag;  // "" for "--"
  std::string data;
};

enum class ZaberLine { kReply, kOther, kDamaged };

// What a line is; a reply fills `reply`. Alerts and infos are kOther; a wrong checksum, a missing
// one where `checksum_expected`, and everything that is not as documented is kDamaged.
ZaberLine read_zaber_line(const std::string& line, bool checksum_expected, ZaberReply& reply);

// Why the stage must not go on, "" for flags that are only notes (and for not being homed).
std::string zaber_fault(const std::string& flag);
bool zaber_flag_means_not_homed(const std::string& flag);
// Of a refused command: the reason in words.
std::string zaber_refusal(const std::string& reason);

}  // namespace hydrodip
