// Removing files by name below a folder, and nothing else: never through a link, never outside.
#pragma once

#include <string>
#include <vector>

namespace rubble {

// Removes the plain files `names` (relative to the folder, "a/b/c") with the suffix appended. Passed
// over: names that are absolute, empty or have a part "." or "..", what is not there, what is no
// plain file (folders, links, pipes), and what lies behind a link, even one inside the folder: each
// part of a name is opened by itself, without following. The folder itself may be a link: it is the
// user's word. Throws RunError for a file that is there and cannot be removed.
void remove_plain_files(const std::string& folder, const std::vector<std::string>& names,
                        const std::string& suffix = "");

// Removes the folders that hold these files, innermost first, where they are empty.
void remove_empty_parents(const std::string& folder, const std::vector<std::string>& names);

// The plain files below FOLDER/NAME, as names relative to FOLDER, sorted; links are not followed.
std::vector<std::string> list_plain_files(const std::string& folder, const std::string& name);

}  // namespace rubble
