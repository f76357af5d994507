/** Has the service worker keep what was loaded before it began, so that the first visit is enough. */
export class OfflineFiles {
  private waiting: string[] = [];
  private keeper: ServiceWorker | null = null;

  /** Keep files by their addresses, now or once there is who keeps them. */
  keep(addresses: string[]): void {
    const loaded = addresses.filter((address) => address.startsWith("http"));
    if (this.keeper) this.keeper.postMessage(loaded);
    else this.waiting.push(...loaded);
  }

  /** Begin to keep: what has been loaded by then, and last the page itself, `worker` among its files. */
  async begin(service: string, worker: string): Promise<void> {
    const container = navigator.serviceWorker as ServiceWorkerContainer | undefined; // there in safe contexts alone
    if (!container) return;
    await container.register(service);
    this.keeper = (await container.ready).active;
    const own = performance.getEntriesByType("resource").map(({ name }) => name);
    const page = new URL(location.href);
    page.hash = "";
    this.keep([...this.waiting.splice(0), ...own, new URL(worker, page).href, page.href]);
  }
}
