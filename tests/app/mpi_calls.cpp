// Counts what a program asks of MPI, for tests: a shared object to be loaded before MPI (LD_PRELOAD). Each
// rank writes the file MPI_CALLS.<rank>. Its collectives stand there one by one, and between two of them the
// messages that the rank has sent:
//
//     collective NAME
//     messages NEIGHBOUR BYTES COUNT

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

#include <mpi.h>

namespace {

std::string written;
std::map<std::pair<int, int>, int> messages;  // since the last collective: count by neighbour and bytes

void end_messages() {
  for (const auto& [of, count] : messages)
    written += "messages " + std::to_string(of.first) + " " + std::to_string(of.second) + " " +
               std::to_string(count) + "\n";
  messages.clear();
}

void collective(const char* name) {
  end_messages();
  written += std::string("collective ") + name + "\n";
}

}  // namespace

extern "C" {

int MPI_Isend(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm ranks,
              MPI_Request* request) {
  int size = 0;
  PMPI_Type_size(type, &size);
  ++messages[{to, count * size}];
  return PMPI_Isend(data, count, type, to, tag, ranks, request);
}

int MPI_Iallgather(const void* data, int count, MPI_Datatype type, void* all, int each,
                   MPI_Datatype type_of_all, MPI_Comm ranks, MPI_Request* request) {
  collective("allgather");
  return PMPI_Iallgather(data, count, type, all, each, type_of_all, ranks, request);
}

int MPI_Iallgatherv(const void* data, int count, MPI_Datatype type, void* all, const int* counts,
                    const int* begins, MPI_Datatype type_of_all, MPI_Comm ranks, MPI_Request* request) {
  collective("allgatherv");
  return PMPI_Iallgatherv(data, count, type, all, counts, begins, type_of_all, ranks, request);
}

int MPI_Igatherv(const void* data, int count, MPI_Datatype type, void* all, const int* counts,
                 const int* begins, MPI_Datatype type_of_all, int root, MPI_Comm ranks,
                 MPI_Request* request) {
  collective("gatherv");
  return PMPI_Igatherv(data, count, type, all, counts, begins, type_of_all, root, ranks, request);
}

int MPI_Finalize() {
  end_messages();
  int rank = 0;
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (const char* const name = std::getenv("MPI_CALLS"))
    if (std::FILE* const file = std::fopen((std::string(name) + "." + std::to_string(rank)).c_str(), "w")) {
      std::fputs(written.c_str(), file);
      std::fclose(file);
    }
  return PMPI_Finalize();
}
}
