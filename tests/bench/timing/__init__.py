"""Other libraries' timing laws on our paths, each as a motion that the verifier can measure."""
