"""The files of a run or of a specimen as arrays, which takes NumPy and h5py alone."""
