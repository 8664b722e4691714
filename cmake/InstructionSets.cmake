# The instruction sets that the step and the rows of contact laws can be compiled for here, the type of each in
# base/lanes.hpp, and its flags. Also part of the package, for laws that are built outside of this project.
# Tuned for generic processors GCC 12 clears lanes with slow string instructions; of its header for AVX-512 it warns.
set(pyroclast_every_instruction_set portable avx2 avx512)
set(pyroclast_known_instruction_sets portable)
set(pyroclast_type_of_portable Portable)
set(pyroclast_flags_of_portable)
set(pyroclast_type_of_avx2 Avx2)
set(pyroclast_flags_of_avx2 -mavx2 -mtune=znver3)
set(pyroclast_type_of_avx512 Avx512)
set(pyroclast_quiet_avx512_header)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(pyroclast_quiet_avx512_header -Wno-uninitialized -Wno-maybe-uninitialized)
endif()
set(pyroclast_flags_of_avx512 -mavx512f -mavx512dq -mavx512vl -mtune=znver3 ${pyroclast_quiet_avx512_header})
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(pyroclast_known_instruction_sets ${pyroclast_every_instruction_set})
  set(pyroclast_flags_of_portable -mtune=znver3)
endif()
# Arithmetic as IEEE 754 has it: contracting a*b+c into one instruction differently in two inlined copies of a loop
# would make the result depend on the optimizer; results are promised bitwise, so it is off.
set(pyroclast_arithmetic_flags -ffp-contract=off -fno-math-errno)
# Of a law outside of this project, whatever the build type and flags of that project.
set(pyroclast_law_flags -O3 ${pyroclast_arithmetic_flags} -fno-fast-math -fvisibility=hidden -fvisibility-inlines-hidden)

# Sets COMPILED and DECLARED in the caller: what is compiled for each instruction set, as C++ writes a list of pointers
# in the order of InstructionSet, and the declarations of those that the files of pyroclast_instruction_sets define.
# They are a member of a template whose first argument is the set; more arguments may follow.
function(pyroclast_list_compiled template member)
  set(compiled)
  set(declared)
  foreach(set IN LISTS pyroclast_every_instruction_set)
    if(NOT set IN_LIST pyroclast_instruction_sets)
      list(APPEND compiled "nullptr")
      continue()
    endif()
    set(arguments "pyroclast::${pyroclast_type_of_${set}}" ${ARGN})
    list(JOIN arguments ", " arguments)
    set(type "pyroclast::${template}<${arguments}>")
    list(APPEND compiled "&${type}::${member}")
    string(APPEND declared "extern template struct ${type};\n")
  endforeach()
  list(JOIN compiled ",\n    " compiled)
  string(STRIP "${declared}" declared)
  set(COMPILED "${compiled}" PARENT_SCOPE)
  set(DECLARED "${declared}" PARENT_SCOPE)
endfunction()
