// Whole files in and out, where they lie, and a hash that identifies them in reports.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hydrodip {

// The file's bytes. Throws InputError naming the path if it is missing, a folder, unreadable.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path);

// Writes bytes; throws InputError naming the path (disk full, no permission).
void write_file(const std::filesystem::path& path, const void* data, std::size_t size);
void write_file(const std::filesystem::path& path, const std::string& text);

// Whether the file lies in the folder or in one of its folders, wherever links on the way to it
// lead.
bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder);

// SHA-256 in lower-case hexadecimal.
std::string sha256_hex(const std::vector<std::uint8_t>& bytes);

}  // namespace hydrodip
