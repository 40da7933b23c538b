#include "job/search_output.h"

#include <fmt/format.h>

#include "base/file.h"
#include "image/files.h"

namespace hydrodip {
namespace {

PreparedObject prepared_in_size(const JobConfig& config, const RunContext& context) {
  PreparedObject prepared = prepare_object(config.model, config.object, context);
  require_size(prepared.posed, config.object, config.model);
  warn_if_sheet_exceeds_bath(config.design.film, config.bath, context);
  return prepared;
}

}  // namespace

SearchOutput::SearchOutput(const JobConfig& config, const std::string& name,
                           const std::vector<std::string>& others, const RunContext& context)
    : config_(config),
      context_(context),
      name_(name),
      folder_(config.output, config.earlier_result),
      prepared_(prepared_in_size(config, context)),
      targets_(job_targets(config, prepared_, context)),
      files_(others) {
  files_.push_back(name + ".json");
  if (config.pictures) files_.push_back(name + ".png");
  std::vector<std::filesystem::path> inputs = prepared_.files;
  inputs.insert(inputs.end(), config.settings_files.begin(), config.settings_files.end());
  if (!config.plan.importance.empty()) inputs.push_back(config.plan.importance);
  folder_.announce(files_, inputs);
  folder_.supersede({name + ".png"});  // where pictures are off now
}

JobResult SearchOutput::finish(std::string json, const std::string& words,
                               const std::function<Image()>& draw) {
  JobResult result;
  result.folder = folder();
  result.files = files_;
  result.json = std::move(json);
  write_file(path(name_ + ".json"), result.json);
  if (config_.pictures) {
    const std::vector<std::uint8_t> png = encode_png(draw());
    write_file(path(name_ + ".png"), png.data(), png.size());
  }
  context_.check_cancelled();
  folder_.commit();
  result.text = words + folder_.told_replaced();
  for (const std::string& warning : context_.warnings())
    result.text += "warning: " + warning + "\n";
  result.text += fmt::format("wrote to {}:", folder().string());
  for (const std::string& file : files_) result.text += " " + file;
  result.text += "\n";
  return result;
}

}  // namespace hydrodip
