// What the program says: results on stdout, everything else on stderr. A closed or broken stream
// never stops a job.
#pragma once

#include <string>

namespace hydrodip {

// Makes sure that descriptors 0 to 2 are taken (a file opened by the job must not become stdout)
// and that a broken pipe is an error of write(), not a signal.
void prepare_console();

void print_result(const std::string& text);
// One line "error: sentence" on stderr; line breaks and control characters are shown as spaces.
void print_error(const std::string& sentence);
void print_notice(const std::string& line);

// Flushes stdout. Throws InputError if the results could not be written (disk full); a reader that
// went away (broken pipe) is not an error.
void finish_results();

}  // namespace hydrodip
