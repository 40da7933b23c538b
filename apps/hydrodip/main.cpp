// The command line: parses, runs a job, and turns what it returns or throws into words and an exit
// code.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <system_error>

#include "base/error.h"
#include "base/memory.h"
#include "base/run_scope.h"
#include "command_line.h"
#include "console.h"
#include "interrupt.h"
#include "progress.h"

namespace hydrodip {
namespace {

constexpr int kExitDone = 0;
constexpr int kExitInput = 2;
constexpr int kExitFailed = 3;
constexpr int kExitDoNotDip = 4;

JobResult run_with_progress(const CommandLine& line, const RunContext& context) {
  ProgressLine progress(line.command->name, ::isatty(STDERR_FILENO) != 0);
  if (!line.request.quiet)
    context.on_progress(
        [&](const std::string& activity, double fraction) { progress.update(activity, fraction); });
  return line.command->run(line.request, context);
}

// Options may name files, and files be pipes that nobody writes to.
CommandLine parsed(const std::vector<std::string>& arguments, const RunContext& context) {
  const RunScope scope(context);
  return parse_command_line(arguments);
}

int run(const std::vector<std::string>& arguments) {
  const RunContext context;
  const CancelOnInterrupt cancel_on_interrupt(context);
  const CommandLine line = parsed(arguments, context);
  bool refused = false;
  if (!line.command) {
    print_result(line.text);
  } else {
    const JobResult result = run_with_progress(line, context);
    print_result(line.request.json ? result.json : result.text);
    refused = line.request.strict && result.do_not_dip;
  }
  finish_results();
  return refused ? kExitDoNotDip : kExitDone;
}

int fail(int code, const std::string& sentence) {
  print_error(sentence);
  return code;
}

std::string out_of_memory() {
  return fmt::format(
      "not enough memory: the job may have {:.0f} MB; a lower print.dpi or film.elements needs "
      "less",
      std::min(memory_limit_bytes(), address_limit_bytes()) / 1e6);
}

int run_safely(const std::vector<std::string>& arguments) {
  try {
    return run(arguments);
  } catch (const InputError& error) {
    return fail(kExitInput, error.what());
  } catch (const DipError& error) {
    return fail(kExitFailed, error.what());
  } catch (const Cancelled& cancelled) {
    print_notice(cancelled.what());
    return kExitCancelled;
  } catch (const std::bad_alloc&) {
    return fail(kExitFailed, out_of_memory());
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(kExitInput, fmt::format("{}: {}; check the path and its permissions",
                                        error.path1().empty() ? "the working directory"
                                                              : error.path1().string(),
                                        error.code().message()));
  } catch (const std::system_error& error) {
    return fail(kExitFailed, std::string("the system refuses what the job needs (") + error.what() +
                                 "); raise its limits, or try --threads 1");
  } catch (const std::exception& error) {
    return fail(kExitFailed, std::string("unexpected: ") + error.what());
  }
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  hydrodip::prepare_console();
  return hydrodip::run_safely({argv + (argc > 0 ? 1 : 0), argv + argc});
}
