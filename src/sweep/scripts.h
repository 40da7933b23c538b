// Scripts that hand a sweep's runs to what runs many programs.
#pragma once

#include <filesystem>
#include <string>

namespace hydrodip {

// So many tasks that each lasts minutes, and a cluster's scheduler is not kept busy; few enough for
// the array sizes that schedulers allow. seconds: of one run; 0: not known.
int tasks_for(std::size_t runs, double seconds);

// GNU parallel, on this machine or over ssh.
std::string parallel_script(int tasks);
// Slurm's array of jobs.
std::string slurm_script(int tasks, const std::filesystem::path& folder);

// Whether nobody has changed the script since one of these made it.
bool is_as_made(const std::string& script);

}  // namespace hydrodip
