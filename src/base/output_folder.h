// Output files that appear under their final names only when all of them are whole.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/folder_lock.h"

namespace hydrodip {

// What becomes of an earlier result of ours in the same place.
enum class EarlierResult { kReplaced, kKept };

// Opens (creating if needed) the folder and a hidden staging folder inside it. Files are written
// to path(name) and moved to their final names by commit(); without commit() the destructor
// removes everything, including folders that the constructor itself created. Staging folders of
// processes that were killed are removed by the next one that opens the folder.
class OutputFolder {
 public:
  // Throws InputError if the folder cannot be created or written to.
  explicit OutputFolder(const std::filesystem::path& folder,
                        EarlierResult earlier = EarlierResult::kReplaced);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  // Says, before anything long is computed, which files will be written and which the job reads.
  // Throws InputError if one of them would overwrite an input, or a file that hydrodip did not
  // write: one without hydrodip's name in it, and without a file among `names` beside it that has;
  // and, if earlier results are kept, if one of the files is there at all.
  void announce(const std::vector<std::string>& names,
                const std::vector<std::filesystem::path>& inputs);
  // Names, which this result does not have, of what an earlier one may have left: beside the new
  // files they would be taken for a part of it, so that commit() removes them. Not what hydrodip
  // did not write, nor what the job reads.
  void supersede(const std::vector<std::string>& names) { superseded_ = names; }
  // Whether commit() has put new files in the place of earlier ones.
  bool replaced_earlier() const { return replaced_earlier_; }
  // After commit(), a line that says so, and what of it is gone; or nothing.
  std::string told_replaced() const;

  // Where to write the file that will be called name; "part/name" lies in a folder inside this one,
  // which is made.
  std::filesystem::path path(const std::string& name);

  // Moves every file asked for with path() to its final name; throws InputError if one is missing
  // or cannot be moved (disk full, permissions), with the earlier content then left in place.
  void commit();

  const std::filesystem::path& folder() const { return folder_; }

 private:
  // The job's input that has that file, whatever it is called; nullptr: none has.
  const std::filesystem::path* input_at(const std::filesystem::path& file) const;
  void remove_superseded() const;

  std::filesystem::path folder_;
  EarlierResult earlier_;
  std::filesystem::path staging_;
  FolderLock lock_;  // on the staging folder
  std::vector<std::filesystem::path> created_;
  std::vector<std::string> names_, superseded_;
  std::vector<std::filesystem::path> inputs_;
  bool replaced_earlier_ = false;
};

}  // namespace hydrodip
