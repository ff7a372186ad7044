"""Studies that the pages of docs/validation quote, one script each, run from the root of the repository.

``PYTHONPATH=. python benchmarks/studies/NAME.py``; its arguments and its time stand at the head of each script. They
share pairs and contacts at random with the tests.
"""
