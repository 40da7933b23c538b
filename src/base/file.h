// Whole files in and out, where they lie, and a hash that identifies them in reports.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hydrodip {

// The file's bytes. Throws InputError naming the path if it is missing, a folder, unreadable.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path);

// Writes bytes; throws InputError naming the path (disk full, no permission), and Cancelled. What
// was written until then stays: for files in an OutputFolder, and in others that go by themselves.
void write_file(const std::filesystem::path& path, const void* data, std::size_t size);
void write_file(const std::filesystem::path& path, const std::string& text);

// What a file is refused with that cannot be written, by whomever. Of one in an OutputFolder that
// is not whole yet the name is told that it was to have.
[[noreturn]] void refuse_write(const std::filesystem::path& path, const std::string& why);

// What becomes of a file that is there already.
enum class ExistingFile { kReplaced, kKept };

// As write_file, but the file appears whole and on the disk, or not at all, and what was there
// stays as it was. A link's own file is replaced, and keeps its permissions. Of a device or a pipe
// nothing is replaced: it is written to. Throws InputError, too, for a file that is to be kept.
void write_whole(const std::filesystem::path& path, const void* data, std::size_t size,
                 ExistingFile existing = ExistingFile::kReplaced);
void write_whole(const std::filesystem::path& path, const std::string& text);

// Whether the file lies in the folder or in one of its folders, wherever links on the way to it
// lead.
bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder);

// SHA-256 in lower-case hexadecimal.
std::string sha256_hex(std::span<const std::uint8_t> bytes);
std::string sha256_hex(std::string_view text);

}  // namespace hydrodip
