#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>
#include <variant>

#include "arrays.h"
#include "base/run_scope.h"
#include "bindings.h"
#include "calibrate/calibrate.h"
#include "job/jobs.h"
#include "job/print_dips.h"
#include "material.h"
#include "model.h"
#include "results.h"
#include "running.h"
#include "settings/profiles.h"
#include "settings/settings.h"

namespace hydrodip::python {

namespace {

// ---- settings ----

struct ConfigHandle {
  JobConfig config;
  JobConfig to_print;  // what a plan is printed with: `quality` is for the search alone
};

// One parameter as Python says it: name, value, the value as written, where it came from.
using Given = std::tuple<std::string, std::variant<double, std::string, std::vector<double>>,
                         std::string, std::string>;

std::vector<Setting> settings_from(const std::vector<Given>& given) {
  std::vector<Setting> settings;
  for (const auto& [name, value, shown, origin] : given) {
    Setting setting{name, {}, false, shown, origin};
    std::visit([&](const auto& v) { setting.value = v; }, value);
    setting.typed = !std::holds_alternative<std::string>(value);
    settings.push_back(std::move(setting));
  }
  return settings;
}

ConfigHandle configure(const std::string& model, const ModelHandle* given,
                       const std::vector<Given>& options, const std::vector<Given>& sets,
                       const std::string& film, const std::string& quality,
                       const std::vector<std::string>& profiles,
                       const std::filesystem::path& profile_folder,
                       const std::vector<std::filesystem::path>& configs,
                       const std::filesystem::path& output, const LawHandle* law) {
  SettingSources sources;
  for (const std::string& name : profiles)
    sources.profiles.push_back(find_profile(name, profile_folder));
  sources.configs = configs;
  if (!quality.empty()) sources.quality = quality_settings(quality);
  if (!film.empty()) sources.options = film_settings(film);
  const std::vector<Setting> named = settings_from(options);
  sources.options.insert(sources.options.end(), named.begin(), named.end());
  sources.sets = settings_from(sets);
  SettingSources without_quality = sources;
  without_quality.quality.clear();
  ConfigHandle handle{configured(model, std::move(sources)),
                      configured(model, std::move(without_quality))};
  for (JobConfig* config : {&handle.config, &handle.to_print}) {
    if (given) {
      config->object.given = given->loaded;
      config->model = model;  // what is named in a file stands back
    }
    if (law) config->design.dip.material.law = law->law;
    config->output = output;
  }
  return handle;
}

// What each parameter is, for keyword arguments, stubs and documentation.
py::list parameter_list() {
  py::list list;
  for (const Parameter& p : parameters()) {
    py::dict entry;
    entry["name"] = p.name;
    entry["unit"] = p.unit;
    entry["default"] = py::cast(p.default_value());
    entry["range"] = show_range(p);
    entry["choices"] = p.choices;
    entry["help"] = p.help;
    list.append(entry);
  }
  return list;
}

// ---- dips as values ----

Simulation simulate(const ConfigHandle& handle, const std::filesystem::path& film_image,
                    const py::object& progress) {
  return run_for<Simulation>(progress, [&](const RunContext& context) {
    JobConfig config = handle.config;
    config.film_image = film_image;
    const RunScope scope(context.with_threads(config.threads));
    Timings times;
    const auto film = std::make_shared<const FilmMesh>(make_film_mesh(config.design.film));
    auto job = std::make_shared<const ReadyJob>(make_ready(config, false, times, context));
    SimulatedJob made = simulated(*job, film, times, context);
    return Simulation{std::move(job), std::move(made.dipped),
                      std::make_shared<const Finish>(std::move(made.finish)), context.warnings()};
  });
}

Design design(const ConfigHandle& handle, const py::object& progress) {
  return run_for<Design>(progress, [&](const RunContext& context) {
    const JobConfig& config = handle.config;
    if (asks_for_several_dips(config))
      throw InputError("design() is for one dip; print_job() makes the sheets of several");
    const RunScope scope(context.with_threads(config.threads));
    Timings times;
    auto job = std::make_shared<const ReadyJob>(make_ready(config, true, times, context));
    DesignedJob made = designed(*job, {.wanted = true, .stretch = false}, times, context);
    DippedObject dipped = made.designed.dipped;
    return Design{{std::move(job), std::move(dipped),
                   std::make_shared<const Finish>(std::move(made.finish)), context.warnings()},
                  std::make_shared<const Designed>(std::move(made.designed))};
  });
}

// ---- jobs that write files ----

struct CommandRequest {
  std::filesystem::path film_image;
  CalibrationRequest calibration;
};

using Command = JobResult (*)(const ConfigHandle&, const CommandRequest&, const RunContext&);

const std::map<std::string, Command>& commands() {
  static const std::map<std::string, Command> all = {
      {"print",
       [](const ConfigHandle& h, const CommandRequest& r, const RunContext& x) {
         if (r.film_image.empty()) return print_job(h.config, x);
         JobConfig config = h.config;
         config.film_image = r.film_image;
         return print_film_image_job(config, x);
       }},
      {"simulate",
       [](const ConfigHandle& h, const CommandRequest& r, const RunContext& x) {
         JobConfig config = h.config;
         config.film_image = r.film_image;
         return simulate_job(config, x);
       }},
      {"orient", [](const ConfigHandle& h, const CommandRequest&,
                    const RunContext& x) { return orient_job(h.config, x); }},
      {"plan", [](const ConfigHandle& h, const CommandRequest&,
                  const RunContext& x) { return plan_job(h.config, x, &h.to_print); }},
      {"measure", [](const ConfigHandle& h, const CommandRequest& r,
                     const RunContext& x) { return measure_job(h.config, r.calibration, x); }},
      {"calibrate",
       [](const ConfigHandle& h, const CommandRequest& r, const RunContext& x) {
         if (h.config.design.dip.material.law)
           throw InputError("calibrate() fits the paper's material; leave out material=");
         return calibrate_job(h.config, r.calibration, x);
       }},
      {"synth", [](const ConfigHandle& h, const CommandRequest& r,
                   const RunContext& x) { return synth_job(h.config, r.calibration, x); }},
  };
  return all;
}

py::tuple run_command(const std::string& name, const ConfigHandle& handle,
                      const std::filesystem::path& film_image, const CalibrationRequest& request,
                      const py::object& progress) {
  const Command command = commands().at(name);
  const auto result = run_for<JobResult>(progress, [&](const RunContext& context) {
    const RunScope scope(context.with_threads(handle.config.threads));
    return command(handle, {film_image, request}, context);
  });
  return py::make_tuple(result.folder, result.files, result.text, result.json, result.do_not_dip);
}

}  // namespace

void bind_jobs(py::module_& m) {
  py::class_<ConfigHandle>(m, "Config");  // NOLINT(bugprone-unused-raii): the module keeps it
  m.def("configure", &configure);
  m.def("parameters", &parameter_list);
  m.def("simulate", &simulate);
  m.def("design", &design);
  py::class_<CalibrationRequest>(m, "CalibrationRequest")
      .def(py::init<>())
      .def_readwrite("scans", &CalibrationRequest::scans)
      .def_readwrite("board", &CalibrationRequest::board)
      .def_readwrite("square_mm", &CalibrationRequest::square_mm)
      .def_readwrite("scan_units", &CalibrationRequest::scan_units)
      .def_readwrite("aligned", &CalibrationRequest::aligned)
      .def_readwrite("mirrored", &CalibrationRequest::mirrored)
      .def_readwrite("z_stretch", &CalibrationRequest::z_stretch)
      .def_readwrite("ratio", &CalibrationRequest::stiffness_ratio)
      .def_readwrite("poisson", &CalibrationRequest::poisson)
      .def_readwrite("torn_rings", &CalibrationRequest::torn_rings)
      .def_readwrite("shard", &CalibrationRequest::shard)
      .def_readwrite("merge", &CalibrationRequest::merged)
      .def_readwrite("noise_mm", &CalibrationRequest::noise_mm)
      .def_readwrite("missing_share", &CalibrationRequest::missing_share)
      .def_readwrite("seed", &CalibrationRequest::seed);
  m.def("run_command", &run_command);
}

}  // namespace hydrodip::python
