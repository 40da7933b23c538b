#include "job/command_text.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <memory>

#include "base/shell_word.h"

namespace hydrodip {
namespace {

// What the system's own shell makes of a command's words, one to a line.
std::vector<std::string> words_in_shell(const std::string& words) {
  const std::string command = "printf '%s\\n' " + words;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::vector<std::string> list(1);
  for (int c = std::fgetc(pipe.get()); c != EOF; c = std::fgetc(pipe.get())) {
    if (c == '\n')
      list.emplace_back();
    else
      list.back() += char(c);
  }
  list.pop_back();
  return list;
}

TEST(ShellWord, IsTheWordInAShell) {
  std::string all;
  const std::vector<std::string> words = {
      "spot.obj",   "my mask.stl", "it's",  "\"quoted\"",     "$HOME",      "`id`", "a;b|c&d", "*",
      "~/part.stl", "back\\slash", "(1)x?", "Kälte 1.5°.png", "!important", "#1",   "a>b<c",   ""};
  for (const std::string& word : words) all += shell_word(word) + " ";
  EXPECT_EQ(words_in_shell(all), words);
  EXPECT_EQ(shell_word("a_b-c/d.e=1,2:3@4%+"), "a_b-c/d.e=1,2:3@4%+");
}

TEST(CommandText, LeavesOutWhereToWriteAndHowToHold) {
  JobConfig config;
  config.command_line = {
      "hydrodip", "orient",  "a mask.obj", "--json",         "-o",       "out",   "--size",
      "80",       "--depth", "12",         "--rotate=0,9,0", "--strict", "--set", "ink.x=1",
      "--down",   "--dips",  "--quiet",    "--dips=3"};
  // "--down" has the next word for its value, whatever it looks like.
  EXPECT_EQ(command_text(config, "print"), "hydrodip print 'a mask.obj' --size 80 --set ink.x=1");
}

TEST(CommandText, OfAJobWithoutACommandLineNamesItsModel) {
  JobConfig config;
  config.model = "parts/a mask.obj";
  EXPECT_EQ(command_text(config, "print"), "hydrodip print 'parts/a mask.obj'");
}

}  // namespace
}  // namespace hydrodip
