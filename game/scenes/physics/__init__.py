"""The gallery of physics: small worlds, each showing one law of the engine, and one step of it taken apart."""
