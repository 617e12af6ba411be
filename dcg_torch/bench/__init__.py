"""How long each part takes, beside its peers: `python -m dcg_torch.bench [--json FILE]`."""
