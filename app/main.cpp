#include "app/command_line/run_program.h"

int main(int argc, char** argv) { return rubble::run_program(argc, argv); }
