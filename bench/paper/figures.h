// The figures and tables of the paper, made anew: one file per figure, listed in main.cpp.
#pragma once

#include <filesystem>
#include <string>

#include "base/context.h"

namespace hydrodip::paper {

struct Study {
  std::filesystem::path folder;  // pictures go here
  const RunContext& context;
};

// Each writes its pictures (figure_5.png, ...) and returns what was measured, as Markdown.
std::string figure_5(const Study& study);
std::string figure_6(const Study& study);
std::string figure_7(const Study& study);
std::string figure_8(const Study& study);
std::string figure_9(const Study& study);
std::string table_1(const Study& study);

}  // namespace hydrodip::paper
