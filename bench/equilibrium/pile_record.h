// One judged pile as a record of figures: a line of JSON, of which tables are made.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/equilibrium/work.h"
#include "bench/settle_run.h"

namespace rubble {

using Record = nlohmann::ordered_json;

// Lengths in mm, times in s, speeds in m/s. Pieces are named "#index type".
Record make_record(const Work& work, const SettleRun& run);

// Adds how far in terrain pieces are, where there is any.
void add_surface_depth(const Pile& pile, const PileState& state, Record& record);

// Asks whether forces exist that hold the pile, and adds what is left over.
void add_balance(const Work& work, const PileState& state, double tolerance, Record& record);

// "#12 stud_long".
std::string name_of_piece(const PileState& state, int index);

// One line for a person: rest, the deepest pair, what is off balance.
std::string describe_record(const Record& record);

// One row a pile. markdown: a table for a document, else columns for a terminal.
std::string make_pile_table(const std::vector<Record>& records, bool markdown);

// One row a work: how many piles settled, mean times, and the worst or sum of its seeds.
std::string make_work_table(const std::vector<Record>& records, bool markdown);

}  // namespace rubble
