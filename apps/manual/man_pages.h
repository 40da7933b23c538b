// Manual pages, man(7).
#pragma once

#include <string>
#include <vector>

#include "describe.h"

namespace hydrodip {

struct ManPage {
  std::string file;  // "hydrodip-print.1"
  std::string text;
};

// hydrodip(1), one for each command, and hydrodip-parameters(5). `release`: "hydrodip 0.1.0";
// `date`: "2026-11-26".
std::vector<ManPage> man_pages(const std::vector<CommandText>& commands, const std::string& release,
                               const std::string& date);

}  // namespace hydrodip
