#include "man_pages.h"

#include <fmt/format.h>

#include <cctype>

#include "command_line.h"
#include "settings/artwork_tables.h"
#include "settings/dip_tables.h"
#include "settings/params.h"

namespace hydrodip {
namespace {

// Text as it stands: no dash becomes a hyphen, no line a request.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n'))
      out += std::string("\\&") + c;
    else
      out += c;
  }
  return out;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

// Words that are typed are bold, the others stand for something.
std::string value(const ValueText& text) {
  std::string out;
  std::string part;
  const auto flush = [&] {
    bool typed = false;
    for (const std::string& word : text.words) typed = typed || word == part;
    if (!part.empty()) out += typed ? bold(part) : italic(part);
    part.clear();
  };
  for (const char c : text.shown) {
    if (c == '|') {
      flush();
      out += "|";
    } else {
      part += c;
    }
  }
  flush();
  return out;
}

// "[PART...]": what stands for something is italic, brackets and dots are as they are.
std::string operands(const std::string& text) {
  std::string out, name;
  for (const char c : text + " ") {
    if (std::string("[]. ").find(c) == std::string::npos) {
      name += c;
      continue;
    }
    if (!name.empty()) out += italic(name);
    name.clear();
    out += c;
  }
  out.pop_back();
  return out;
}

std::string heading(const std::string& page, int section, const std::string& release,
                    const std::string& date, const std::string& summary) {
  return fmt::format(".TH {} {} \"{}\" \"{}\" \"hydrodip manual\"\n.SH NAME\n{} \\- {}\n", page,
                     section, date, release, roff(page), roff(summary));
}

// Lines that stand as they are.
std::string as_typed(const std::string& lines) {
  return ".nf\n" + roff(lines) + (lines.ends_with('\n') ? "" : "\n") + ".fi\n";
}

std::string item(const std::string& tag, const std::string& text) {
  return ".TP\n" + tag + "\n" + roff(text) + "\n";
}

std::string option_tag(const OptionText& option) {
  std::string tag = option.short_name.empty() ? "" : bold(option.short_name) + ", ";
  tag += bold(option.name);
  if (option.value.kind != ValueKind::kNone) tag += " " + value(option.value);
  return tag;
}

std::string exit_status() {
  std::string text = ".SH \"EXIT STATUS\"\n";
  for (const Remark& code : exit_codes()) text += item(bold(code.what), code.means);
  return text;
}

std::string see_also(const std::vector<std::string>& pages) {
  std::string text = ".SH \"SEE ALSO\"\n";
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const std::size_t at = pages[i].find('(');
    text += ".BR " + roff(pages[i].substr(0, at)) + " " + pages[i].substr(at) +
            (i + 1 < pages.size() ? " ,\n" : "\n");
  }
  return text;
}

std::string sentence(std::string text) {
  if (!text.empty()) text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
  return text + ".";
}

std::string general_page(const std::vector<CommandText>& commands, const std::string& release,
                         const std::string& date) {
  std::string text = heading("hydrodip", 1, release, date,
                             "from a textured model to a film image to print on PVA film and dip");
  text +=
      ".SH SYNOPSIS\n.B hydrodip\n.I COMMAND\n.RI [ OPTIONS ]\n.br\n"
      ".B hydrodip \\-\\-version\n.br\n.B hydrodip \\-\\-help\n";
  text +=
      ".SH DESCRIPTION\nA film that is pulled over an object stretches: an image printed as it "
      "should look\nends up somewhere else.\n.B hydrodip\nsimulates the floating film as the "
      "object comes down through it, notes which bit of film\nsticks where, and draws the image "
      "backwards from that.\nLengths are in mm, angles in degrees.\n";
  text += ".SH COMMANDS\n";
  for (const CommandText& command : commands)
    text += ".TP\n.BR " + roff(command.page()) + " (1)\n" + roff(command.summary) + "\n";
  text += ".SH EXAMPLES\n";
  std::string lines;
  for (const std::string& command : first_commands()) lines += command + "\n";
  text += as_typed(lines);
  text += exit_status() + ".SH ENVIRONMENT\n";
  for (const Remark& variable : environment_variables())
    text += item(bold(variable.what), variable.means + ".");
  std::vector<std::string> pages;
  pages.reserve(commands.size() + 1);
  for (const CommandText& command : commands) pages.push_back(command.page() + "(1)");
  pages.push_back("hydrodip-parameters(5)");
  return text + see_also(pages);
}

std::string command_page(const CommandText& command, const std::string& release,
                         const std::string& date) {
  std::string text = heading(command.page(), 1, release, date, command.summary);
  text += ".SH SYNOPSIS\n.B hydrodip " + roff(command.name) + "\n";
  if (!command.operands.empty()) text += operands(command.operands) + "\n";
  text += ".RI [ OPTIONS ]\n.SH DESCRIPTION\n" + roff(sentence(command.summary)) + "\n";
  if (!command.details.empty()) text += ".PP\n" + as_typed(command.details);
  if (!command.arguments.empty()) text += ".SH ARGUMENTS\n";
  for (const ArgumentText& argument : command.arguments)
    text += item(italic(argument.name), argument.help);
  text += ".SH OPTIONS\n";
  for (const std::string& group : command.groups) {
    if (group != "Options") text += ".SS \"" + roff(group) + "\"\n";
    for (const OptionText& option : command.options)
      if (option.group == group) text += item(option_tag(option), option.help);
  }
  return text + exit_status() + see_also({"hydrodip(1)", "hydrodip-parameters(5)"});
}

std::string parameters_page(const std::string& release, const std::string& date) {
  std::string text =
      heading("hydrodip-parameters", 5, release, date, "job files, profiles, and every parameter");
  text +=
      ".SH DESCRIPTION\nA profile describes film, printer and bath, a configuration a job; both "
      "are TOML files\nof parameters, for\n.B \\-\\-profile\nand\n.BR \\-\\-config .\n"
      "A job file is a configuration that names its model, as\n.BR object.file ,\nand stands "
      "where a model may stand, or is given by\n.B \\-\\-config\nalone. Paths in a file are "
      "relative to it.\n.B \\-\\-set "
      "\\fINAME\\fR=\\fIVALUE\\fR\nhas the last word.\n";
  std::string group;
  for (const Parameter& p : parameters()) {
    const std::string this_group = p.name.substr(0, p.name.find('.'));
    if (this_group != group) text += ".SH \"" + roff(this_group) + "\"\n";
    group = this_group;
    text += ".TP\n" + bold(p.name) + "\n" + roff(p.help) + ".\n.br\n" + roff(show_range(p));
    const std::string usual = show_value(p, p.default_value());
    if (!usual.empty()) text += "; default: " + roff(usual);
    text += "\n";
  }
  text +=
      ".SH \"ARTWORK TABLES\"\nLayers on the object, the bottom one first, each a\n.B "
      "[[artwork]]\ntable.\n";
  for (const LayerKey& key : layer_keys())
    text += ".TP\n" + bold(key.name) + "\n" + roff(key.help) + ".\n.br\n" + roff(key.range) + "\n";
  text += ".SH \"DIP TABLES\"\nSeveral dips, each a\n.B [[dip]]\ntable with\n";
  for (std::size_t i = 0; i < dip_keys().size(); ++i)
    text += ".BR " + roff(dip_keys()[i]) + (i + 1 < dip_keys().size() ? " ,\n" : " .\n");
  text += "What is not given is looked for.\n";
  text +=
      ".SH \"PART TABLES\"\nSeveral parts on one sheet, each a\n.B [[part]]\ntable with\n.B "
      "job\n(a model, or a job's file) and\n.BR count .\n";
  text += ".SH EXAMPLE\n";
  text += as_typed(
      "[object]\nfile = \"cup.stl\"\ndown = \"-y\"\n\n[dip]\ndepth_mm = 13\n\n[[artwork]]\n"
      "image = \"label.svg\"\nprojection = \"cylinder\"\nsize_mm = 50\n");
  return text + see_also({"hydrodip(1)"});
}

}  // namespace

std::vector<ManPage> man_pages(const std::vector<CommandText>& commands, const std::string& release,
                               const std::string& date) {
  std::vector<ManPage> pages = {{"hydrodip.1", general_page(commands, release, date)},
                                {"hydrodip-parameters.5", parameters_page(release, date)}};
  for (const CommandText& command : commands)
    pages.push_back({command.page() + ".1", command_page(command, release, date)});
  return pages;
}

}  // namespace hydrodip
