// Settings from TOML: the only place that knows toml++.
//
// toml++ 3.3 trusts an assertion where a table header does not start with a key ("[=]"), and
// without it reads on in undefined territory. Here its assertions stay on, and throw.
#undef NDEBUG
namespace hydrodip::toml_assertion {
struct Failed {};
constexpr void check(bool holds) {
  if (!holds) throw Failed();
}
}  // namespace hydrodip::toml_assertion
#define TOML_ASSERT(expr) ::hydrodip::toml_assertion::check(static_cast<bool>(expr))
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "settings/artwork_tables.h"
#include "settings/settings.h"

namespace hydrodip {
namespace {

// A configuration is a page of text; anything larger is the wrong file.
constexpr std::size_t kLargestFile = 1 << 20;

// Tables that may stand several times.
constexpr const char *kArtworkTables = "artwork", *kPartTables = "part", *kDipTables = "dip";

struct Located {
  Setting setting;
  std::uint32_t line = 0;
  std::uint32_t column = 0;
};

class SettingReader {
 public:
  explicit SettingReader(const std::filesystem::path& file) : file_(file) {}

  toml::table table() const {
    const std::vector<std::uint8_t> bytes = read_file(file_);
    if (bytes.size() > kLargestFile)
      throw InputError(fmt::format("{}: too large for a configuration file", file_.string()));
    return parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }

  std::vector<Setting> read() {
    collect(table(), "");
    // toml++ keeps keys sorted by name; the file's own order decides which error comes first.
    std::stable_sort(found_.begin(), found_.end(), [](const Located& a, const Located& b) {
      return std::pair(a.line, a.column) < std::pair(b.line, b.column);
    });
    std::vector<Setting> settings;
    for (Located& located : found_) settings.push_back(std::move(located.setting));
    return settings;
  }

 private:
  // toml++ and what it makes recurse along dotted keys and into brackets.
  void check_nesting(std::string_view text) const {
    constexpr int kMost = 32;
    int dots = 0, depth = 0;
    std::size_t line = 1;
    char quote = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const char c = text[i];
      if (c == '\n') {
        ++line;
        dots = 0;
        quote = 0;  // strings of several lines hold no keys either, and may only hide dots
      } else if (quote) {
        if (c == '\\' && quote == '"') ++i;
        if (c == quote) quote = 0;
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '#') {
        while (i + 1 < text.size() && text[i + 1] != '\n') ++i;
      } else if (c == '.') {
        ++dots;
      } else if (c == '=' || c == ',') {
        dots = 0;
      } else if (c == '[' || c == '{') {
        ++depth;
        dots = 0;
      } else if (c == ']' || c == '}') {
        --depth;
        dots = 0;
      }
      if (dots > kMost || depth > kMost)
        throw InputError(
            fmt::format("{}:{}:1: not a setting: it is nested more than {} levels deep",
                        file_.string(), line, kMost));
    }
  }

  toml::table parse(std::string_view text) const {
    check_nesting(text);
    try {
      return toml::parse(text, file_.string());
    } catch (const toml::parse_error& error) {
      const auto& at = error.source().begin;
      throw InputError(fmt::format("{}:{}:{}: not valid TOML: {}", file_.string(), at.line,
                                   at.column, error.description()));
    } catch (const toml_assertion::Failed&) {
      throw InputError(fmt::format("{}:{}:1: not valid TOML: a table's name must follow '['",
                                   file_.string(), line_of_failed_assertion(text)));
    }
  }

  // The assertion does not say where it failed: looks for the shortest run of lines that fails it.
  static std::size_t line_of_failed_assertion(std::string_view text) {
    std::vector<std::size_t> ends;  // of each line
    for (std::size_t at = 0; at < text.size(); ++at)
      if (text[at] == '\n' || at + 1 == text.size()) ends.push_back(at + 1);
    const auto fails = [&](std::size_t end) {
      try {
        static_cast<void>(toml::parse(text.substr(0, end)));
      } catch (const toml::parse_error&) {
      } catch (const toml_assertion::Failed&) {
        return true;
      }
      return false;
    };
    const auto first = std::partition_point(ends.begin(), ends.end(),
                                            [&](std::size_t end) { return !fails(end); });
    return static_cast<std::size_t>(first - ends.begin()) + 1;
  }

  void collect(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, node] : table) {
      const std::string name = prefix + std::string(key.str());
      if (const toml::table* inner = node.as_table())
        collect(*inner, name + ".");
      else if ((name == kArtworkTables || name == kPartTables || name == kDipTables) &&
               node.is_array_of_tables())
        collect_tables(*node.as_array(), name);
      else
        add(name, key.source().begin, node);
    }
  }

  // [[artwork]], once for each layer: artwork[1].size_mm and so on. [[part]] and [[dip]] likewise.
  void collect_tables(const toml::array& tables, const std::string& name) {
    int number = 0;
    for (const toml::node& table : tables) {
      const std::string prefix = fmt::format("{}[{}].", name, ++number);
      // A dip of which nothing is said is one all the same.
      if (name == kDipTables) {
        const auto& at = table.source().begin;
        found_.push_back({{prefix + "locked", "false", true, "false",
                           fmt::format("{}:{}", file_.string(), at.line)},
                          at.line,
                          at.column});
      }
      collect(*table.as_table(), prefix);
    }
  }

  // As a parameter of that type is read.
  static ParameterType type_of(const std::string& name, const std::string& origin) {
    if (name.starts_with("dip[")) {
      if (name.ends_with("].correction")) return ParameterType::kPath;
      return name.ends_with("].path") ? ParameterType::kWayIn : ParameterType::kText;
    }
    const bool table = name.starts_with("artwork[") || name.starts_with("part[");
    if (!table) return find_parameter(name, origin).type;
    return is_artwork_path(name) || name.ends_with("].job") ? ParameterType::kPath
                                                            : ParameterType::kText;
  }

  // [dips] says what holds for all [[dip]]s: TOML has no room for a [dip] beside them.
  static std::string known_name(const std::string& name) {
    return name.starts_with("dips.") ? "dip." + name.substr(5) : name;
  }
  static bool is_switch(const std::string& name) {
    return is_artwork_switch(name) || (name.starts_with("dip[") && name.ends_with("].locked"));
  }

  void add(const std::string& given, const toml::source_position& at, const toml::node& node) {
    const std::string origin = fmt::format("{}:{}", file_.string(), at.line);
    const std::string name = known_name(given);
    const ParameterType type = type_of(name, origin);
    Located located;
    located.line = at.line;
    located.column = at.column;
    Setting& setting = located.setting;
    setting = {name, std::string(), true, shown(node), origin};
    if (const auto number = as_number(node))
      setting.value = *number;
    else if (const auto text = node.value_exact<std::string>())
      setting.value = type == ParameterType::kPath || type == ParameterType::kWayIn
                          ? beside_file(*text)
                          : *text;
    else if (const auto* flag = node.as_boolean(); flag && is_switch(name))
      setting.value = std::string(flag->get() ? "true" : "false");
    else
      setting.value = type == ParameterType::kWayIn ? as_rows(node) : as_numbers(node);
    found_.push_back(std::move(located));
  }

  // Only TOML's own numbers: true is not 1.
  static std::optional<double> as_number(const toml::node& node) {
    if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
    if (const auto* real = node.as_floating_point()) return real->get();
    return {};
  }

  // Empty, which no parameter accepts, for anything but an array of numbers.
  static std::vector<double> as_numbers(const toml::node& node) {
    std::vector<double> numbers;
    const toml::array* array = node.as_array();
    if (!array) return {};
    for (const toml::node& element : *array) {
      const auto number = as_number(element);
      if (!number) return {};
      numbers.push_back(*number);
    }
    return numbers;
  }

  // Rows of six numbers, one after the other; empty for anything else.
  static std::vector<double> as_rows(const toml::node& node) {
    std::vector<double> all;
    const toml::array* array = node.as_array();
    if (!array) return {};
    for (const toml::node& row : *array) {
      const std::vector<double> numbers = as_numbers(row);
      if (numbers.size() != 6) return {};
      all.insert(all.end(), numbers.begin(), numbers.end());
    }
    return all;
  }

  std::string beside_file(const std::string& path) const {
    return path.empty() ? path : (file_.parent_path() / path).string();
  }

  // For messages. toml++'s own printer cannot print the smallest integer.
  static std::string shown(const toml::node& node) { return fmt::format("'{}'", printed(node)); }

  static std::string printed(const toml::node& node) {
    if (const auto text = node.value_exact<std::string>()) return text->substr(0, 200);
    if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
    if (const auto* real = node.as_floating_point()) return fmt::format("{}", real->get());
    if (const auto* boolean = node.as_boolean()) return boolean->get() ? "true" : "false";
    const toml::array* array = node.as_array();
    if (!array) return "a date or time";
    std::string text;
    for (const toml::node& element : *array) {
      if (text.size() > 100) return fmt::format("[{}, ...]", text);
      text += (text.empty() ? "" : ", ") + (element.is_table() ? "{...}" : printed(element));
    }
    return fmt::format("[{}]", text);
  }

  std::filesystem::path file_;
  std::vector<Located> found_;
};

nlohmann::ordered_json as_json(const toml::node& node) {
  using Json = nlohmann::ordered_json;
  if (const toml::table* table = node.as_table()) {
    Json object = Json::object();
    for (const auto& [key, value] : *table) object[std::string(key.str())] = as_json(value);
    return object;
  }
  if (const toml::array* array = node.as_array()) {
    Json list = Json::array();
    for (const toml::node& value : *array) list.push_back(as_json(value));
    return list;
  }
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* real = node.as_floating_point()) return real->get();
  if (const auto* flag = node.as_boolean()) return flag->get();
  if (const auto text = node.value_exact<std::string>()) return *text;
  return nullptr;  // a date or time
}

}  // namespace

std::string toml_as_json(const std::filesystem::path& file) {
  return as_json(SettingReader(file).table())
      .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::vector<Setting> read_settings(const std::filesystem::path& file) {
  return SettingReader(file).read();
}

}  // namespace hydrodip
