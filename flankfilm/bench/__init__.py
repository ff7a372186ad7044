"""Error against cost of every solver on this machine: cases, measurement, peers, tables and report."""
