// What people do with their profiles.
#pragma once

#include <filesystem>
#include <string>

#include "job/jobs.h"
#include "settings/profiles.h"

namespace hydrodip {

// Every profile in the folder and what it sets; broken ones with what is wrong with them.
JobResult list_profiles(const std::filesystem::path& folder);

// The profile as it stands. Throws InputError with the nearest known name if there is none.
JobResult show_profile(const std::filesystem::path& folder, const std::string& name);

// Makes the profile, or changes these values of it and keeps the others. Throws InputError, and
// then nothing has changed.
JobResult save_profile(const std::filesystem::path& folder, const std::string& name,
                       const ProfileEdit& edit);

// Takes a profile from elsewhere, under its own name or another. Throws InputError if there is one
// of that name, or the file is none.
JobResult import_profile(const std::filesystem::path& folder, const std::filesystem::path& file,
                         const std::string& name);

}  // namespace hydrodip
