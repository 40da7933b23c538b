#include "rig/zaber_message.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <sstream>

namespace hydrodip {
namespace {

struct Meaning {
  const char* code;
  const char* words;
};

// Highest priority first, as the manual lists them. Flags that are missing here are notes.
constexpr std::array<Meaning, 13> kFaults = {{
    {"FD", "the motor driver has switched itself off"},
    {"FQ", "the encoder's signal is bad"},
    {"FS", "the stage has stalled and stopped: look for what is in its way"},
    {"FT", "the axes are twisted too far"},
    {"FB", "a stream of movements left its bounds"},
    {"FP", "the stage deviated from its path"},
    {"FE", "a limit sensor was not reached or is faulty"},
    {"WL", "a limit sensor was met where none should be"},
    {"WP", "the calibration does not suit the device"},
    {"WV", "the supply voltage is out of range"},
    {"WT", "the controller is too hot: let it cool"},
    {"WM", "the stage was pushed out of its place: home it again"},
    {"NC", "somebody is turning the knob on the stage"},
}};

constexpr std::array<Meaning, 9> kRefusals = {{
    {"AGAIN", "it cannot do that right now"},
    {"BADAXIS", "it has no such axis"},
    {"BADCOMMAND", "it does not know the command"},
    {"BADDATA", "the value is out of its range"},
    {"DEVICEONLY", "that is a command for the device, not for an axis"},
    {"FULL", "it has no room left for that"},
    {"NOACCESS", "its access level forbids that"},
    {"PARKED", "it is parked: send it 'tools parking unpark'"},
    {"STATUSBUSY", "it is busy"},
}};

template <std::size_t N>
std::string look_up(const std::array<Meaning, N>& table, const std::string& code) {
  for (const Meaning& meaning : table)
    if (code == meaning.code) return meaning.words;
  return "";
}

bool read_number(const std::string& text, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

bool is_flag(const std::string& text) {
  const auto upper = [](char c) { return c >= 'A' && c <= 'Z'; };
  return text == "--" || (text.size() == 2 && upper(text[0]) && upper(text[1]));
}

// Takes the checksum off; false if it is wrong or, where expected, missing.
bool take_checksum(std::string& line, bool expected) {
  const std::size_t colon = line.rfind(':');
  if (colon == std::string::npos || colon + 3 != line.size()) return !expected;
  const bool right = line.substr(colon + 1) == zaber_checksum(line.substr(1, colon - 1));
  line.erase(colon);
  return right;
}

bool read_reply(const std::string& line, ZaberReply& reply) {
  std::istringstream words(line.substr(1));
  std::string address, axis, word, status, flag;
  words >> address >> axis >> word;
  reply = {};
  if (address.size() != 2 || axis.size() != 1) return false;
  if (!read_number(address, reply.address) || !read_number(axis, reply.axis)) return false;
  if (word.size() == 2 && read_number(word, reply.id)) words >> word;
  words >> status >> flag;
  if ((word != "OK" && word != "RJ") || (status != "IDLE" && status != "BUSY")) return false;
  if (!is_flag(flag)) return false;
  std::getline(words >> std::ws, reply.data);
  reply.accepted = word == "OK";
  reply.busy = status == "BUSY";
  reply.flag = flag == "--" ? "" : flag;
  return true;
}

}  // namespace

std::string zaber_checksum(const std::string& between) {
  unsigned sum = 0;
  for (const char c : between) sum += static_cast<unsigned char>(c);
  return fmt::format("{:02X}", (256 - sum % 256) % 256);
}

std::string zaber_command(int address, int axis, int id, const std::string& text) {
  const std::string body =
      fmt::format("{} {} {:02}{}{}", address, axis, id, text.empty() ? "" : " ", text);
  return "/" + body + ":" + zaber_checksum(body) + "\n";
}

ZaberLine read_zaber_line(const std::string& line, bool checksum_expected, ZaberReply& reply) {
  std::string text = line;
  if (text.empty() || !take_checksum(text, checksum_expected)) return ZaberLine::kDamaged;
  if (text[0] == '!' || text[0] == '#') return ZaberLine::kOther;
  if (text[0] != '@' || !read_reply(text, reply)) return ZaberLine::kDamaged;
  return ZaberLine::kReply;
}

std::string zaber_fault(const std::string& flag) {
  std::string known = look_up(kFaults, flag);
  if (known.empty() && !flag.empty() && flag[0] == 'F') return "the stage reports a fault";
  return known;
}

bool zaber_flag_means_not_homed(const std::string& flag) { return flag == "WR" || flag == "WH"; }

std::string zaber_refusal(const std::string& reason) {
  std::string known = look_up(kRefusals, reason);
  return known.empty() ? reason : known;
}

}  // namespace hydrodip
