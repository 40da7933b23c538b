// JSON as the program writes it, into files and to whoever reads its answers.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hydrodip {

// Indented, with a line end. Bytes that are no UTF-8, as file names may have, are replaced.
std::string json_text(const nlohmann::ordered_json& json);
// The same in one line, without its end.
std::string json_line(const nlohmann::ordered_json& json);

// What a command says with --json: schema_version and command, then the members, an object.
std::string json_answer(const std::string& command, const nlohmann::ordered_json& members);

}  // namespace hydrodip
