// One web page about a batch: means of its scores, plots, a picture of every run, and its table.
#pragma once

#include <string>

namespace rubble {

struct ReportOptions {
  int pictures = 1000;  // at most; the first of the table
  int width = 320;      // of a picture, at most; unit: pixel
  std::string way;    // from where the page lies to the batch, ending in "/"; empty: beside index.csv
};

// The page holds all that it shows; only its links to the datasets lead out of it. Throws
// InputError when there is no batch in it, or its index.csv cannot be read.
std::string make_batch_report(const std::string& folder, const ReportOptions& options);

}  // namespace rubble
