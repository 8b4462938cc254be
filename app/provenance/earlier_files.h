// What an earlier run left in an output folder, as far as it can be told from its manifest and its
// list. Both may have been altered by whoever had the folder: a name counts only where a run writes
// a file of that name.
#pragma once

#include <string>
#include <vector>

namespace rubble {

// The files that every run may leave, the manifest first: without it nothing is taken for whole.
const std::vector<std::string>& usual_run_files();

// Plain files of the run that was here: names relative to the folder.
std::vector<std::string> files_of_earlier_run(const std::string& folder);

// What an earlier run keeps in the folder `unfinished`, but for its lock.
void clear_unfinished(const std::string& folder);

// The folder `unfinished` with the files that a run keeps there; anything else in it stays, and the
// folder then, too.
void remove_unfinished(const std::string& folder);

// What other commands made of the run that was here, such as a map of its voids: it stays, and is of another pile then.
// Names in the folder, sorted.
std::vector<std::string> find_derived_files(const std::string& folder);

// What a run that was killed had finished is made anew: files are replaced, folders must go.
void remove_folder_of_killed_run(const std::string& path);

// Throws InputError when a folder that recordings are written into holds files which the earlier run
// did not write: to write there, they would have to go.
void refuse_foreign_recordings(const std::string& folder);

// Throws InputError when a run, finished or not, recorded the file `path` that the option `option` names.
void refuse_recorded_file(const std::string& path, const std::string& option);

// For `rubble COMMAND`, "convert" or "export", which replaces files below `out`. Throws InputError when that is the
// dataset, a folder that the dataset is in, the folder of another run or a part of one.
void refuse_run_folder(const std::string& out, const std::string& dataset, const std::string& command);

}  // namespace rubble
