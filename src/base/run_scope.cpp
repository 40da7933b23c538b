#include "base/run_scope.h"

#include "base/parallel.h"
#include "base/thread_budget.h"

namespace hydrodip {

RunScope::RunScope(const RunContext& context) : context_(context), before_(work_here) {
  work_here.context = &context_;
  if (context_.threads() >= available_threads()) return;
  work_here.budget = context_.budget_.get();
  work_here.awake = nullptr;  // more than this job may use
}

RunScope::~RunScope() { work_here = before_; }

void check_cancelled() {
  if (work_here.context != nullptr) work_here.context->check_cancelled();
}

void warn(const std::string& sentence) {
  if (work_here.context != nullptr) work_here.context->warn(sentence);
}

}  // namespace hydrodip
