// Names of columns in tables that other programs wrote, with their units: "t [ms]", "x (ft)", "yaw_deg". Shared by readers of
// trajectories and of accelerograms.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace rubble {

bool is_one_of(const std::string& word, std::initializer_list<const char*> words);

// In seconds, metres or radians. 0: the word is no such unit. Lower case.
double time_unit(const std::string& word);
double length_unit(const std::string& word);
double angle_unit(const std::string& word);

// For messages: what the functions above know.
inline constexpr const char* kTimeUnits = "s, ms, us, ns, min or h";
inline constexpr const char* kLengthUnits = "m, cm, mm, km, ft or in";
inline constexpr const char* kAngleUnits = "rad or deg";

// "p_RS_R_x [m]": the words p, rs, r, x, and the unit m.
struct ColumnName {
  std::vector<std::string> tokens;  // lower case, letters and digits
  std::string unit;                 // the text in brackets or parentheses, in lower case; empty: none
};
ColumnName read_column_name(const std::string& name);

// Words between blanks, of which one like "[ns]" belongs to the word before it.
std::vector<std::string> join_units(const std::vector<std::string_view>& words);

}  // namespace rubble
