#include "interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>

namespace hydrodip {
namespace {

// A signal handler can reach nothing but a global.
std::atomic<const RunContext*> interrupted_context{nullptr};

void handle(int) {
  const RunContext* const context = interrupted_context.load();
  if (!context) ::_exit(kExitCancelled);
  const int bearable = context->expects_second_cancel() ? 2 : 1;
  if (context->cancel_requests() >= bearable) ::_exit(kExitCancelled);
  context->cancel();
}

void install(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    // nohup keeps a job alive when its terminal goes; scripts' background jobs, which ignore
    // SIGINT too, can still be cancelled.
    if (signal == SIGHUP && sigaction(signal, nullptr, &before) == 0 &&
        before.sa_handler == SIG_IGN)
      continue;
    sigaction(signal, &action, nullptr);
  }
}

}  // namespace

CancelOnInterrupt::CancelOnInterrupt(const RunContext& context) {
  interrupted_context.store(&context);
  install(handle);
}

CancelOnInterrupt::~CancelOnInterrupt() {
  install(SIG_DFL);
  interrupted_context.store(nullptr);
}

}  // namespace hydrodip
