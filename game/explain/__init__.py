"""What several screens show of a network, a run and a flight: values, network, inputs, code beside numbers."""
